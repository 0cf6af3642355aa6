#include "render/volume/corner_table.h"

#include <algorithm>
#include <array>
#include <new>

#include "base/parallel.h"

namespace stormcellar::render {
namespace {

using grid::brick_edge;

constexpr double most_cells = 1 << 24;

using Row = std::array<std::uint8_t, brick_edge>;  // the codes of a column in one brick
constexpr Row no_values{};

bool has_values(const grid::BrickView& view, int bx, int by, int bz) {
    const grid::BrickEntry& entry = view.bricks[view.brick_index(bx, by, bz)];
    return entry.kind == grid::BrickKind::stored && entry.value_count > 0;
}

}  // namespace

// The cells of one column of bricks, and of its neighbors to the east and north.
struct CornerTable::Columns {
    int bx, by;
    int past_x, past_y;  // cells of the bricks that are in the grid
};

bool CornerTable::serves(const grid::BrickView& view, double samples) {
    const auto cells = static_cast<double>(view.spec->cell_count());
    return view.quantization.code_bytes == 1 && cells <= most_cells && samples >= 12 * cells;
}

// Makes room for the words. calloc() returns zeros that take no memory until they are touched.
void CornerTable::make_room(const grid::BrickView& view) {
    stride_y_ = view.spec->nz() + 1;
    stride_x_ = view.spec->ny * stride_y_;
    const auto count =
        static_cast<std::size_t>(view.spec->nx) * static_cast<std::size_t>(stride_x_);
    if (count == word_count_ && written_.size() == view.bricks.size()) return;
    words_.reset(static_cast<std::uint32_t*>(std::calloc(count, sizeof(std::uint32_t))));
    if (!words_) throw std::bad_alloc();
    word_count_ = count;
    written_.assign(view.bricks.size(), 0);
}

void CornerTable::fill(const grid::BrickView& view, int threads) {
    make_room(view);
    for_each_piece(view.bricks_x, threads, [&](int bx) {
        for (int by = 0; by < view.bricks_y; ++by)
            fill_bricks(view, bx, by);
    });
}

void CornerTable::fill_bricks(const grid::BrickView& view, int bx, int by) {
    const Columns columns{bx, by, std::min(brick_edge, view.spec->nx - bx * brick_edge),
                          std::min(brick_edge, view.spec->ny - by * brick_edge)};
    for (int bz = 0; bz < view.bricks_z; ++bz)
        fill_brick(view, columns, bz);
}

// Writes the words of one brick, which also need the first columns of the neighbors to the east and
// north. A brick without values is skipped, unless an earlier grid left words in it. If such a
// brick touches a neighbor with values, only the columns along that border are written.
void CornerTable::fill_brick(const grid::BrickView& view, const Columns& columns, int bz) {
    const auto [bx, by, past_x, past_y] = columns;
    const int levels = std::min(brick_edge, view.spec->nz() - bz * brick_edge);
    const bool is_last_x = bx + 1 == view.bricks_x, is_last_y = by + 1 == view.bricks_y;
    const std::byte* bricks[4] = {};  // null for a brick without values
    for (int c = 0; c < 4; ++c) {
        const int x = bx + c % 2, y = by + c / 2;
        if (x == view.bricks_x || y == view.bricks_y || !has_values(view, x, y, bz)) continue;
        bricks[c] = view.codes.data() + view.brick_index(x, y, bz) * grid::brick_cells;
    }
    char& written = written_[view.brick_index(bx, by, bz)];
    const bool whole = bricks[0] != nullptr;
    const bool any = whole || bricks[1] != nullptr || bricks[2] != nullptr || bricks[3] != nullptr;
    if (!any && written == 0) return;
    const auto row = [&](int x, int y) {
        const int c = x / brick_edge + 2 * (y / brick_edge);
        if (bricks[c] == nullptr) return no_values.data();
        return reinterpret_cast<const std::uint8_t*>(bricks[c]) +
               ((x % brick_edge) * brick_edge + y % brick_edge) * brick_edge;
    };
    for (int x = 0; x < past_x; ++x) {
        const int east = is_last_x && x + 1 == past_x ? x : x + 1;
        for (int y = 0; y < past_y; ++y) {
            const bool touched = whole || x + 1 == brick_edge || y + 1 == brick_edge;
            if (!touched && written == 0) continue;
            const int north = is_last_y && y + 1 == past_y ? y : y + 1;
            const std::uint8_t* a = row(x, y);
            const std::uint8_t* b = row(east, y);
            const std::uint8_t* c = row(x, north);
            const std::uint8_t* d = row(east, north);
            std::array<std::uint32_t, brick_edge> words;
            // Interleave the codes of four columns into words, 16 levels at a time, in a loop that
            // the compiler vectorizes.
            for (std::size_t z = 0; z < words.size(); ++z) {
                words[z] =
                    static_cast<std::uint32_t>(a[z]) | static_cast<std::uint32_t>(b[z]) << 8 |
                    static_cast<std::uint32_t>(c[z]) << 16 | static_cast<std::uint32_t>(d[z]) << 24;
            }
            std::uint32_t* to = at(bx * brick_edge + x, by * brick_edge + y, bz * brick_edge);
            if (levels == brick_edge) {
                std::copy_n(words.begin(), brick_edge, to);
            } else {
                std::copy_n(words.begin(), levels, to);
            }
            // the level above the last level
            if (bz + 1 == view.bricks_z) to[levels] = to[levels - 1];
        }
    }
    written = any ? 1 : 0;
}

}  // namespace stormcellar::render
