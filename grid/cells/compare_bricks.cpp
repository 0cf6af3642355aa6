#include "grid/cells/compare_bricks.h"

#include "base/parallel.h"
#include "grid/cells/code_block.h"

namespace stormcellar::grid {
namespace {

// Compares the bricks that have the same bx.
class RowComparer {
  public:
    RowComparer(const BrickView& a, const BrickView& b, BrickDifferences& found)
        : a_(a), b_(b), found_(found) {}

    void compare(int bx) {
        for (int by = 0; by < a_.bricks_y; ++by) {
            const ColumnBox box{bx * brick_edge, by * brick_edge,
                                std::min((bx + 1) * brick_edge, a_.spec->nx) - 1,
                                std::min((by + 1) * brick_edge, a_.spec->ny) - 1};
            for (int bz = 0; bz < a_.bricks_z; ++bz)
                compare(box, bz);
        }
    }

  private:
    void compare(const ColumnBox& box, int bz) {
        const auto not_seen = [&](const BrickView& view) {
            return CodeBlock::uniform_status(view, box, bz) == CellStatus::not_seen;
        };
        if (not_seen(a_) && not_seen(b_)) return;
        codes_a_.read(a_, box, bz);
        codes_b_.read(b_, box, bz);
        const int levels = std::min(brick_edge, a_.spec->nz() - bz * brick_edge);
        for (int ix = box.x0; ix <= box.x1; ++ix) {
            for (int iy = box.y0; iy <= box.y1; ++iy) {
                const std::uint16_t* a = codes_a_.column(ix, iy);
                const std::uint16_t* b = codes_b_.column(ix, iy);
                for (int level = 0; level < levels; ++level)
                    add(a[level], b[level]);
            }
        }
    }
    void add(std::uint16_t a, std::uint16_t b) {
        if (a == 0 && b == 0) return;
        ++found_.status.compared;
        const bool valued_a = a >= a_.quantization.first_code();
        const bool valued_b = b >= b_.quantization.first_code();
        if (valued_a && valued_b) {
            found_.values.push_back(a_.quantization.value_of(a) - b_.quantization.value_of(b));
        } else if (valued_a != valued_b || a != b) {
            ++found_.status.disagreeing;
        }
    }

    const BrickView& a_;
    const BrickView& b_;
    BrickDifferences& found_;
    CodeBlock codes_a_, codes_b_;
};

}  // namespace

std::optional<accuracy::ErrorSummary> BrickDifferences::summary() const {
    const std::vector<double> errors(values.begin(), values.end());
    return accuracy::summarize(errors);
}

Result<BrickDifferences> compare_bricks(const BrickView& a, const BrickView& b, int threads) {
    if (*a.spec != *b.spec) {
        return fail(ErrorCode::bad_argument, "grids of different cells cannot be compared");
    }
    std::vector<BrickDifferences> rows(static_cast<std::size_t>(a.bricks_x));
    for_each_piece(a.bricks_x, threads, [&](int bx) {
        RowComparer(a, b, rows[static_cast<std::size_t>(bx)]).compare(bx);
    });
    BrickDifferences all;
    for (const BrickDifferences& row : rows) {
        all.values.insert(all.values.end(), row.values.begin(), row.values.end());
        all.status += row.status;
    }
    return all;
}

}  // namespace stormcellar::grid
