#include "render/products/ground.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/image/round_step.h"
#include "render/image/shades.h"
#include "render/products/smooth_field.h"
#include "stormcellar/render/colour_table.h"

namespace stormcellar::render {
namespace {

// Returns true for the pixels of the dots that mark a value "at least".
bool is_dot(int x, int y, double scale) {
    const int period = std::max(4, static_cast<int>(std::lround(6 * scale)));
    const int size = std::max(1, static_cast<int>(std::lround(2 * scale)));
    const int shift = (y / period) % 2 == 0 ? 0 : period / 2;
    return (x + shift) % period < size && y % period < size;
}

// Calls shade(column, x, y, point of the ground) for every pixel over the grid.
template <class Shade>
Image paint(const grid::GridSpec& spec, const ViewGeometry& geometry, int threads, Shade shade) {
    Image image(geometry.width(), geometry.height(), shades::page);
    for_each_piece(image.height, threads, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            const auto p = geometry.ground({x + 0.5, y + 0.5});
            const std::ptrdiff_t column = p ? column_at(spec, *p) : -1;
            if (column >= 0) image.set(x, y, shade(static_cast<std::size_t>(column), x, y, *p));
        }
    });
    return image;
}

}  // namespace

std::ptrdiff_t column_at(const grid::GridSpec& spec, GroundPoint p) {
    const double ix = std::floor(p.x_m / spec.cell_width_m() + 0.5 * spec.nx);
    const double iy = std::floor(p.y_m / spec.cell_height_m() + 0.5 * spec.ny);
    if (!(ix >= 0 && ix < spec.nx && iy >= 0 && iy < spec.ny)) return -1;
    return static_cast<std::ptrdiff_t>(iy) * spec.nx + static_cast<std::ptrdiff_t>(ix);
}

Image paint_ground(const grid::GridSpec& spec, const std::vector<ColumnSummary>& columns,
                   const ViewGeometry& geometry, GroundTells tells, double scale, int threads) {
    return paint(spec, geometry, threads, [&](std::size_t column, int x, int y, GroundPoint) {
        const std::uint16_t lowest = columns[column].lowest_seen;
        if (lowest == ColumnSummary::never) return shades::hatched(x, y, scale);
        const bool low = spec.levels_m[lowest] < low_coverage_m;
        return low || tells == GroundTells::whether_seen ? shades::seen : shades::seen_aloft;
    });
}

Rgba8 shade_of(const FlatField& field, std::size_t place, const ColourTable& table, int x, int y,
               double scale) {
    const bool at_least = !field.at_least.empty() && field.at_least[place] != 0;
    return shade_of(field.status[place], field.values[place], at_least, table, x, y, scale);
}

Rgba8 shade_of(grid::CellStatus status, float value, bool at_least, const ColourTable& table, int x,
               int y, double scale) {
    switch (status) {
        case grid::CellStatus::value: {
            const auto colour = colour_of(table, value);
            if (!colour) return shades::seen;
            return at_least && is_dot(x, y, scale) ? shades::page : over(*colour, shades::seen);
        }
        case grid::CellStatus::range_folded:
            return over(table.range_folded, shades::seen);
        case grid::CellStatus::no_echo:
            return shades::seen;
        case grid::CellStatus::not_seen:
            break;
    }
    return shades::hatched(x, y, scale);
}

Image paint_field(const grid::GridSpec& spec, const FlatField& field, const ColourTable& table,
                  const ViewGeometry& geometry, double scale, int threads, bool smoothed) {
    if (!smoothed) {
        return paint(spec, geometry, threads, [&](std::size_t column, int x, int y, GroundPoint) {
            return shade_of(field, column, table, x, y, scale);
        });
    }
    const SmoothField smooth(field);
    return paint(spec, geometry, threads, [&](std::size_t column, int x, int y, GroundPoint p) {
        const auto place = smooth.at(p.x_m / spec.cell_width_m() + 0.5 * (spec.nx - 1),
                                     p.y_m / spec.cell_height_m() + 0.5 * (spec.ny - 1));
        const bool at_least = !field.at_least.empty() && field.at_least[column] != 0;
        return shade_of(place.status, place.value, at_least, table, x, y, scale);
    });
}

}  // namespace stormcellar::render
