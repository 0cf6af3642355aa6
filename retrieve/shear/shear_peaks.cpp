#include "stormcellar/retrieve/shear_peaks.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::retrieve {
namespace {

using grid::brick_edge;
using grid::BrickView;

constexpr float units_per_s = 1000;  // AZSH is in 0.001/s

struct ColumnShear {
    int ix = 0, iy = 0, level = 0;
    float shear = 0;  // in units of the grid
};

struct LevelRange {
    int first = 0, end = 0;
};

LevelRange levels_within(const std::vector<double>& levels_m, const ShearPeakOptions& options) {
    const auto first = std::ranges::lower_bound(levels_m, options.bottom_m);
    const auto end = std::ranges::upper_bound(levels_m, options.top_m);
    return {static_cast<int>(first - levels_m.begin()), static_cast<int>(end - levels_m.begin())};
}

// Raises the columns of a brick to the shear of its cells.
void raise_columns(const BrickView& shear, int bx, int by, int bz, LevelRange levels, float least,
                   std::vector<ColumnShear>& columns) {
    const grid::BrickExtent extent = grid::brick_extent(*shear.spec, bx, by, bz);
    const int first = std::max(levels.first, bz * brick_edge);
    const int end = std::min(levels.end, bz * brick_edge + extent.z);
    for (int i = 0; i < extent.x; ++i) {
        for (int j = 0; j < extent.y; ++j) {
            const int ix = bx * brick_edge + i, iy = by * brick_edge + j;
            ColumnShear& column = columns[static_cast<std::size_t>(i * brick_edge + j)];
            for (int level = first; level < end; ++level) {
                const std::uint16_t code =
                    shear.code_at(shear.offset_x(ix) + shear.offset_y(iy) + shear.offset_z(level));
                if (shear.quantization.status_of(code) != grid::CellStatus::value) continue;
                const float value = shear.quantization.value_of(code);
                if (value >= least && value > column.shear) column = {ix, iy, level, value};
            }
        }
    }
}

// Returns the columns that reach the least shear, the strongest first.
std::vector<ColumnShear> strong_columns(const BrickView& shear, const ShearPeakOptions& options) {
    const LevelRange levels = levels_within(shear.spec->levels_m, options);
    const float least = std::max(options.least_per_s * units_per_s, 0.0F);
    std::vector<ColumnShear> strong;
    std::vector<ColumnShear> columns;
    for (int bx = 0; bx < shear.bricks_x; ++bx) {
        for (int by = 0; by < shear.bricks_y; ++by) {
            columns.assign(static_cast<std::size_t>(brick_edge) * brick_edge, {});
            for (int bz = levels.first / brick_edge; bz * brick_edge < levels.end; ++bz) {
                const grid::BrickEntry& brick = shear.bricks[shear.brick_index(bx, by, bz)];
                if (brick.kind == grid::BrickKind::stored &&
                    shear.quantization.value_of(brick.max_code) >= least)
                    raise_columns(shear, bx, by, bz, levels, least, columns);
            }
            std::ranges::copy_if(columns, std::back_inserter(strong),
                                 [](const ColumnShear& column) { return column.shear > 0; });
        }
    }
    std::ranges::sort(strong, [](const ColumnShear& a, const ColumnShear& b) {
        if (a.shear != b.shear) return a.shear > b.shear;
        return a.iy != b.iy ? a.iy < b.iy : a.ix < b.ix;
    });
    return strong;
}

}  // namespace

std::vector<ShearPeak> shear_peaks(const BrickView& shear, const ShearPeakOptions& options) {
    std::vector<ShearPeak> peaks;
    const grid::GridSpec& spec = *shear.spec;
    const grid::GridProjection projection(spec);
    for (const ColumnShear& column : strong_columns(shear, options)) {
        if (peaks.size() >= options.most) break;
        const bool is_near = std::ranges::any_of(peaks, [&](const ShearPeak& stronger) {
            return std::hypot(spec.x_m(column.ix) - spec.x_m(stronger.ix),
                              spec.y_m(column.iy) - spec.y_m(stronger.iy)) < options.separation_m;
        });
        if (is_near) continue;
        peaks.push_back(
            {projection.to_geo({static_cast<double>(column.ix), static_cast<double>(column.iy)}),
             column.ix, column.iy, column.shear / units_per_s,
             spec.levels_m[static_cast<std::size_t>(column.level)]});
    }
    return peaks;
}

}  // namespace stormcellar::retrieve
