#include "retrieve/cells/strong_echo.h"

#include <algorithm>
#include <array>

namespace stormcellar::retrieve {
namespace {

// Returns the level of each code, 0 below the least reflectivity.
std::vector<std::uint8_t> levels_of_codes(const grid::Quantization& codes, float least_dbz) {
    constexpr float most_level = 255;
    std::vector<std::uint8_t> levels(std::size_t{codes.largest_code()} + 1, 0);
    for (std::size_t code = codes.first_code(); code < levels.size(); ++code) {
        const float above = codes.value_of(static_cast<std::uint16_t>(code)) - least_dbz;
        if (above >= 0)
            levels[code] =
                static_cast<std::uint8_t>(std::min(1 + above / level_step_db, most_level));
    }
    return levels;
}

}  // namespace

StrongEcho::StrongEcho(const grid::BrickView& view, float least_dbz)
    : nx_(view.spec->nx),
      ny_(view.spec->ny),
      nz_(view.spec->nz()),
      bricks_y_(view.bricks_y),
      bricks_z_(view.bricks_z),
      least_dbz_(least_dbz),
      slots_(view.bricks.size(), -1) {
    collect(view, levels_of_codes(view.quantization, least_dbz));
    sort_by_level();
}

void StrongEcho::collect(const grid::BrickView& view, const std::vector<std::uint8_t>& levels) {
    constexpr int edge = grid::brick_edge;
    std::int32_t slot = 0;
    for (std::size_t brick = 0; brick < view.bricks.size(); ++brick) {
        const grid::BrickEntry& entry = view.bricks[brick];
        if (entry.kind != grid::BrickKind::stored || levels[entry.max_code] == 0) continue;
        slots_[brick] = slot++;
        const auto z = static_cast<int>(brick % static_cast<std::size_t>(bricks_z_));
        const auto row = static_cast<int>(brick / static_cast<std::size_t>(bricks_z_));
        const int y = row % bricks_y_, x = row / bricks_y_;
        for (std::size_t i = 0; i < grid::brick_cells; ++i) {
            const std::uint8_t level = levels[view.code_at(brick * grid::brick_cells + i)];
            if (level == 0) continue;
            const auto within = static_cast<int>(i);
            cells_.push_back({static_cast<std::int16_t>(x * edge + within / (edge * edge)),
                              static_cast<std::int16_t>(y * edge + within / edge % edge),
                              static_cast<std::int16_t>(z * edge + within % edge), level});
        }
    }
    index_.assign(static_cast<std::size_t>(slot) * grid::brick_cells, -1);
}

// Sorts by counting, which keeps the order within a level, and fills in the lookup.
void StrongEcho::sort_by_level() {
    constexpr std::size_t edge = grid::brick_edge;
    std::array<std::size_t, 257> starts{};  // of the level 255 - i in the sorted cells
    for (const StrongGridCell& cell : cells_)
        ++starts[256 - cell.level];
    for (std::size_t i = 1; i < starts.size(); ++i)
        starts[i] += starts[i - 1];
    std::vector<StrongGridCell> sorted(cells_.size());
    for (const StrongGridCell& cell : cells_) {
        const std::size_t place = starts[255 - cell.level]++;
        sorted[place] = cell;
        const auto x = static_cast<std::size_t>(cell.ix), y = static_cast<std::size_t>(cell.iy),
                   z = static_cast<std::size_t>(cell.iz);
        const std::size_t brick = (x / edge * static_cast<std::size_t>(bricks_y_) + y / edge) *
                                      static_cast<std::size_t>(bricks_z_) +
                                  z / edge;
        index_[static_cast<std::size_t>(slots_[brick]) * grid::brick_cells +
               (x % edge * edge + y % edge) * edge + z % edge] = static_cast<std::int32_t>(place);
    }
    cells_ = std::move(sorted);
}

}  // namespace stormcellar::retrieve
