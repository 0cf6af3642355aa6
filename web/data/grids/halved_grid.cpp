#include "web/data/grids/halved_grid.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace stormcellar::web {
namespace {

using grid::BrickEntry;
using grid::BrickKind;
using grid::CellStatus;

// The codes of one brick of any kind. States of cells are codes below 3.
template <class Code>
class BrickCodes {
  public:
    void read(const grid::BrickView& view, std::size_t brick) {
        const BrickEntry& entry = view.bricks[brick];
        switch (entry.kind) {
            case BrickKind::uniform:
                codes_.fill(static_cast<Code>(entry.uniform_status));
                return;
            case BrickKind::status_only:
                read_states(
                    view.states.subspan(std::size_t{entry.status_index} * grid::state_block_bytes,
                                        grid::state_block_bytes));
                return;
            case BrickKind::stored:
                std::memcpy(codes_.data(), view.codes.data() + brick * sizeof codes_,
                            sizeof codes_);
                return;
        }
    }
    [[nodiscard]] Code at(int x, int y, int z) const { return column(x, y)[z]; }
    // Returns the 16 cells of the column at x, y.
    [[nodiscard]] const Code* column(int x, int y) const {
        return codes_.data() + (x * grid::brick_edge + y) * grid::brick_edge;
    }

  private:
    void read_states(std::span<const std::byte> states) {
        for (std::size_t i = 0; i < states.size(); ++i) {
            const auto four = std::to_integer<unsigned>(states[i]);
            for (unsigned cell = 0; cell < 4; ++cell)
                codes_[4 * i + cell] = static_cast<Code>((four >> (2 * cell)) & 3U);
        }
    }

    std::array<Code, grid::brick_cells> codes_{};
};

// Makes one cell of up to four.
class CellHalver {
  public:
    CellHalver(const grid::Quantization& quantization, HalvedBy by, bool by_magnitude)
        : quantization_(quantization), by_(by), by_magnitude_(by_magnitude) {}

    void add(std::uint16_t code) {
        const grid::CellStatus status = quantization_.status_of(code);
        if (status == grid::CellStatus::ambiguous) ++ambiguous_;
        if (status == grid::CellStatus::ambiguous) return;
        ++counts_[std::min<std::size_t>(code, 3)];
        if (status != grid::CellStatus::value) return;
        sum_ += code;
        if (counts_[3] == 1 || is_greater(code)) greatest_ = code;
    }
    std::uint16_t finish() {
        const std::uint16_t code = by_ == HalvedBy::maximum ? maximum() : mean();
        counts_ = {};
        sum_ = ambiguous_ = 0;
        return code;
    }

  private:
    [[nodiscard]] bool is_greater(std::uint16_t code) const {
        if (!by_magnitude_) return code > greatest_;
        const float magnitude = std::abs(quantization_.value_of(code));
        const float before = std::abs(quantization_.value_of(greatest_));
        return magnitude > before || (magnitude == before && code > greatest_);
    }
    [[nodiscard]] std::uint16_t maximum() const {
        if (counts_[3] > 0) return greatest_;
        if (ambiguous_ > 0) return ambiguous_code;
        return counts_[2] > 0 ? 2 : counts_[1] > 0 ? 1 : 0;
    }
    [[nodiscard]] std::uint16_t mean() const {
        const auto [not_seen, no_echo, folded, values] = counts_;
        const std::uint32_t unknown = folded + ambiguous_;
        if (unknown > no_echo && unknown > values) return folded >= ambiguous_ ? 2 : ambiguous_code;
        if (no_echo > values) return 1;
        if (values > 0) return static_cast<std::uint16_t>((2 * sum_ + values) / (2 * values));
        return folded > 0 ? 2 : ambiguous_ > 0 ? ambiguous_code : 0;
    }

    const grid::Quantization& quantization_;
    HalvedBy by_;
    bool by_magnitude_;
    static constexpr std::uint16_t ambiguous_code = 3;
    std::array<std::uint32_t, 4> counts_{};  // how many of the cells have each state
    std::uint32_t ambiguous_ = 0;
    std::uint32_t sum_ = 0;
    std::uint16_t greatest_ = 0;
};

template <class Code>
class GridHalver {
  public:
    GridHalver(const grid::BrickView& from, grid::BrickGrid& to, HalvedBy by, bool by_magnitude)
        : from_(from),
          to_(to),
          cell_(from.quantization, by, by_magnitude),
          by_code_(by == HalvedBy::maximum && !by_magnitude) {}

    void run() {
        const grid::BrickView shape = to_.view();
        grid::BricksWriter writer(to_);
        for (int bx = 0; bx < shape.bricks_x; ++bx) {
            for (int by = 0; by < shape.bricks_y; ++by) {
                for (int bz = 0; bz < shape.bricks_z; ++bz)
                    make_brick(writer, shape, bx, by, bz);
            }
        }
        to_.finish({&writer, 1});
    }

  private:
    // Returns the state that all source bricks of a halved brick have; none if they differ. Most
    // bricks are uniform, so this often makes it unnecessary to read their cells.
    [[nodiscard]] std::optional<CellStatus> uniform_above(int bx, int by, int bz) const {
        std::optional<CellStatus> status;
        for (int x = 2 * bx; x < std::min(2 * bx + 2, from_.bricks_x); ++x) {
            for (int y = 2 * by; y < std::min(2 * by + 2, from_.bricks_y); ++y) {
                const BrickEntry& entry = from_.bricks[from_.brick_index(x, y, bz)];
                if (entry.kind != BrickKind::uniform) return std::nullopt;
                if (status && *status != entry.uniform_status) return std::nullopt;
                status = entry.uniform_status;
            }
        }
        return status;
    }

    void make_brick(grid::BricksWriter& writer, const grid::BrickView& shape, int bx, int by,
                    int bz) {
        const std::size_t brick = shape.brick_index(bx, by, bz);
        if (const auto status = uniform_above(bx, by, bz)) {
            return writer.put_uniform(brick, *status);
        }
        codes_.fill(0);
        const grid::BrickExtent extent = grid::brick_extent(to_.spec(), bx, by, bz);
        for (int half_x = 0; half_x < 2; ++half_x) {
            for (int half_y = 0; half_y < 2; ++half_y) {
                const int x = 2 * bx + half_x;
                const int y = 2 * by + half_y;
                if (x >= from_.bricks_x || y >= from_.bricks_y) continue;
                source_.read(from_, from_.brick_index(x, y, bz));
                const grid::BrickExtent quarter = grid::brick_extent(*from_.spec, x, y, bz);
                if (by_code_)
                    take_greatest(quarter, half_x, half_y);
                else
                    take_quarter(quarter, half_x, half_y);
            }
        }
        writer.put_codes(brick, codes_.data(), extent);
    }

    // Returns the column of the halved grid that covers columns 2 x, 2 x + 1 and rows 2 y, 2 y + 1
    // of a source brick.
    Code* halved_column(int half_x, int half_y, int x, int y) {
        constexpr int half_edge = grid::brick_edge / 2;
        return codes_.data() +
               ((half_x * half_edge + x) * grid::brick_edge + half_y * half_edge + y) *
                   grid::brick_edge;
    }

    // Takes the greatest code. This also ranks the states, because they are the smallest codes.
    // Beyond the grid's edge, a uniform brick continues, and cells of other bricks are not seen.
    void take_greatest(const grid::BrickExtent& extent, int half_x, int half_y) {
        for (int x = 0; 2 * x < extent.x; ++x) {
            for (int y = 0; 2 * y < extent.y; ++y) {
                const Code* south_west = source_.column(2 * x, 2 * y);
                const Code* north_west = source_.column(2 * x, 2 * y + 1);
                const Code* south_east = source_.column(2 * x + 1, 2 * y);
                const Code* north_east = source_.column(2 * x + 1, 2 * y + 1);
                std::array<Code, grid::brick_edge> greatest;
                for (std::size_t z = 0; z < greatest.size(); ++z) {
                    greatest[z] = std::max(std::max(south_west[z], north_west[z]),
                                           std::max(south_east[z], north_east[z]));
                }
                std::copy_n(greatest.begin(), extent.z, halved_column(half_x, half_y, x, y));
            }
        }
    }

    void take_quarter(const grid::BrickExtent& extent, int half_x, int half_y) {
        for (int x = 0; 2 * x < extent.x; ++x) {
            for (int y = 0; 2 * y < extent.y; ++y) {
                Code* column = halved_column(half_x, half_y, x, y);
                for (int z = 0; z < extent.z; ++z) {
                    for (int fine_x = 2 * x; fine_x < std::min(2 * x + 2, extent.x); ++fine_x) {
                        for (int fine_y = 2 * y; fine_y < std::min(2 * y + 2, extent.y); ++fine_y)
                            cell_.add(source_.at(fine_x, fine_y, z));
                    }
                    column[z] = static_cast<Code>(cell_.finish());
                }
            }
        }
    }

    const grid::BrickView& from_;
    grid::BrickGrid& to_;
    CellHalver cell_;
    bool by_code_;  // a greater code means a greater value
    BrickCodes<Code> source_;
    std::array<Code, grid::brick_cells> codes_{};
};

std::shared_ptr<const grid::BrickGrid> halved_once(const grid::BrickView& view, HalvedBy by,
                                                   bool by_magnitude) {
    auto made = std::make_shared<grid::BrickGrid>(halved_spec(*view.spec), view.quantization);
    if (view.quantization.code_bytes == 1) {
        GridHalver<std::uint8_t>(view, *made, by, by_magnitude).run();
    } else {
        GridHalver<std::uint16_t>(view, *made, by, by_magnitude).run();
    }
    return made;
}

}  // namespace

std::optional<HalvedBy> halved_by_from_name(std::string_view name) {
    if (name == "maximum") return HalvedBy::maximum;
    if (name == "mean") return HalvedBy::mean;
    return std::nullopt;
}

std::string_view halved_by_name(HalvedBy by) {
    return by == HalvedBy::maximum ? "maximum" : "mean";
}

// Column i of the halved grid is in the middle of the columns 2 i and 2 i + 1.
grid::GridSpec halved_spec(const grid::GridSpec& spec) {
    grid::GridSpec half = spec;
    half.nx = (spec.nx + 1) / 2;
    half.ny = (spec.ny + 1) / 2;
    half.spacing_m = spec.spacing_m * 2;
    half.spacing_deg = spec.spacing_deg * 2;
    half.offset_x_cells = 0.5 * (half.nx - 1) - (spec.center_x() - 0.5) / 2;
    half.offset_y_cells = 0.5 * (half.ny - 1) - (spec.center_y() - 0.5) / 2;
    return half;
}

Result<std::shared_ptr<const grid::BrickGrid>> halved(const grid::BrickView& view,
                                                      level2::Moment moment, int times,
                                                      HalvedBy by) {
    if (times < 1 || times > most_halvings) {
        return fail(ErrorCode::bad_argument, "half: 1 to {}, not {}", most_halvings, times);
    }
    const bool has_classes = level2::facts_of(moment).is_categorical;
    if (by == HalvedBy::mean && (has_classes || level2::is_circular(moment))) {
        return fail(ErrorCode::bad_argument, "by: {} {} and has no mean; ask for by=maximum",
                    level2::moment_name(moment), has_classes ? "has classes" : "lies on a circle");
    }
    const bool by_magnitude = level2::facts_of(moment).is_signed;
    std::shared_ptr<const grid::BrickGrid> half = halved_once(view, by, by_magnitude);
    for (int i = 1; i < times; ++i)
        half = halved_once(half->view(), by, by_magnitude);
    return half;
}

}  // namespace stormcellar::web
