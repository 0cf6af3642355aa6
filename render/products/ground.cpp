#include "render/products/ground.h"

#include <cmath>

#include "base/parallel.h"
#include "render/colour/colour_table.h"
#include "render/shades.h"

namespace stormcellar::render {
namespace {

// The column under a ground point; -1 beyond the grid.
std::ptrdiff_t column_at(const grid::GridSpec& spec, GroundPoint p) {
    const double ix = std::floor(p.x_m / spec.cell_width_m() + 0.5 * spec.nx);
    const double iy = std::floor(p.y_m / spec.cell_height_m() + 0.5 * spec.ny);
    if (!(ix >= 0 && ix < spec.nx && iy >= 0 && iy < spec.ny)) return -1;
    return static_cast<std::ptrdiff_t>(iy) * spec.nx + static_cast<std::ptrdiff_t>(ix);
}

// Calls shade(column, x, y) for every pixel over the grid.
template <class Shade>
Image paint(const grid::GridSpec& spec, const ViewGeometry& geometry, int threads, Shade shade) {
    Image image(geometry.width(), geometry.height(), shades::page);
    for_each_piece(image.height, threads, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            const auto p = geometry.ground({x + 0.5, y + 0.5});
            const std::ptrdiff_t column = p ? column_at(spec, *p) : -1;
            if (column >= 0) image.set(x, y, shade(static_cast<std::size_t>(column), x, y));
        }
    });
    return image;
}

}  // namespace

Image paint_ground(const grid::GridSpec& spec, const std::vector<ColumnSummary>& columns,
                   const ViewGeometry& geometry, double scale, int threads) {
    return paint(spec, geometry, threads, [&](std::size_t column, int x, int y) {
        const std::uint16_t lowest = columns[column].lowest_seen;
        if (lowest == ColumnSummary::never) return shades::hatched(x, y, scale);
        return spec.levels_m[lowest] < low_coverage_m ? shades::seen : shades::seen_aloft;
    });
}

Image paint_composite(const grid::BrickView& view, const ColourTable& table,
                      const std::vector<ColumnSummary>& columns, const ViewGeometry& geometry,
                      double scale, int threads) {
    return paint(*view.spec, geometry, threads, [&](std::size_t column, int x, int y) {
        const ColumnSummary& summary = columns[column];
        switch (summary.status()) {
            case grid::CellStatus::value:
                return colour_of(table, view.quantization.value_of(summary.max_code))
                    .value_or(shades::seen);
            case grid::CellStatus::range_folded:
                return table.range_folded;
            case grid::CellStatus::no_echo:
                return shades::seen;
            case grid::CellStatus::not_seen:
                break;
        }
        return shades::hatched(x, y, scale);
    });
}

}  // namespace stormcellar::render
