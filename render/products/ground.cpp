#include "render/products/ground.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
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

// Seen at a slant, the ground goes on by so much of the grid's half width.
constexpr double slanted_reach = 1.5;
// Seen from straight above it goes on as far as maps hold.
constexpr double farthest_m = 2e6;

// Calls shade(column, patch) for every pixel over the grid.
template <class Shade>
Image paint(const grid::GridSpec& spec, const ViewGeometry& geometry, const GroundLook& look,
            int threads, Shade shade) {
    Image image(geometry.width(), geometry.height(), look.shades->page);
    for_each_piece(image.height, threads, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            const auto p = geometry.ground({x + 0.5, y + 0.5});
            if (!p) continue;
            const std::ptrdiff_t column = column_at(spec, *p);
            if (column < 0 && look.water == nullptr) continue;
            const GroundPatch patch{x, y, look.water != nullptr ? look.water->water_at(*p) : 0, *p};
            image.set(x, y,
                      column >= 0 ? shade(static_cast<std::size_t>(column), patch)
                                  : patch.shade(look, &GroundShades::beyond));
        }
    });
    return image;
}

}  // namespace

bool is_from_above(const ViewGeometry& geometry) {
    return !geometry.is_perspective() && geometry.forward()[2] == -1;
}

std::ptrdiff_t column_at(const grid::GridSpec& spec, GroundPoint p) {
    const double ix = std::floor(p.x_m / spec.cell_width_m() + 0.5 * spec.nx);
    const double iy = std::floor(p.y_m / spec.cell_height_m() + 0.5 * spec.ny);
    if (!(ix >= 0 && ix < spec.nx && iy >= 0 && iy < spec.ny)) return -1;
    return static_cast<std::ptrdiff_t>(iy) * spec.nx + static_cast<std::ptrdiff_t>(ix);
}

Image paint_ground(const grid::GridSpec& spec, const std::vector<ColumnSummary>& columns,
                   const ViewGeometry& geometry, GroundTells tells, const GroundLook& look,
                   int threads) {
    return paint(spec, geometry, look, threads, [&](std::size_t column, const GroundPatch& patch) {
        const std::uint16_t lowest = columns[column].lowest_seen;
        if (lowest == ColumnSummary::never) return patch.unseen(look);
        const bool low = spec.levels_m[lowest] < low_coverage_m;
        return patch.shade(look, low || tells == GroundTells::whether_seen
                                     ? &GroundShades::seen
                                     : &GroundShades::seen_aloft);
    });
}

Rgba8 shade_of(const FlatField& field, std::size_t place, const ColourTable& table,
               const GroundPatch& patch, const GroundLook& look) {
    const bool at_least = !field.at_least.empty() && field.at_least[place] != 0;
    return shade_of(field.status[place], field.values[place], at_least, table, patch, look);
}

Rgba8 shade_of(grid::CellStatus status, float value, bool at_least, const ColourTable& table,
               const GroundPatch& patch, const GroundLook& look) {
    const Rgba8 plain = patch.shade(look, &GroundShades::seen);
    switch (status) {
        case grid::CellStatus::value: {
            const auto colour = colour_of(table, value);
            if (!colour) return plain;
            return at_least && is_dot(patch.x, patch.y, look.scale) ? look.shades->page
                                                                    : over(*colour, plain);
        }
        case grid::CellStatus::range_folded:
            return over(table.range_folded, plain);
        case grid::CellStatus::no_echo:
            return plain;
        case grid::CellStatus::not_seen:
            break;
    }
    return patch.unseen(look);
}

Image paint_field(const grid::GridSpec& spec, const FlatField& field, const ColourTable& table,
                  const ViewGeometry& geometry, const GroundLook& look, int threads,
                  bool smoothed) {
    if (!smoothed) {
        return paint(spec, geometry, look, threads,
                     [&](std::size_t column, const GroundPatch& patch) {
                         return shade_of(field, column, table, patch, look);
                     });
    }
    const SmoothField smooth(field);
    return paint(spec, geometry, look, threads, [&](std::size_t column, const GroundPatch& patch) {
        const auto place = smooth.at(patch.point.x_m / spec.cell_width_m() + 0.5 * (spec.nx - 1),
                                     patch.point.y_m / spec.cell_height_m() + 0.5 * (spec.ny - 1));
        const bool at_least = !field.at_least.empty() && field.at_least[column] != 0;
        return shade_of(place.status, place.value, at_least, table, patch, look);
    });
}

double reach_beyond_m(const ViewGeometry& geometry) {
    if (is_from_above(geometry)) return farthest_m;
    return slanted_reach * std::max(geometry.half_x_m(), geometry.half_y_m());
}

void fade_beyond(const ViewGeometry& geometry, const Shades& shades, int threads, Image& picture) {
    if (is_from_above(geometry)) return;
    const double reach_m = reach_beyond_m(geometry);
    for_each_piece(picture.height, threads, [&](int y) {
        for (int x = 0; x < picture.width; ++x) {
            const auto p = geometry.ground({x + 0.5, y + 0.5});
            if (!p) continue;
            const double beyond_m =
                std::hypot(std::max(0.0, std::abs(p->x_m) - geometry.half_x_m()),
                           std::max(0.0, std::abs(p->y_m) - geometry.half_y_m()));
            if (beyond_m == 0) continue;
            const double share = std::min(1.0, beyond_m / reach_m);
            picture.set(x, y, mixed(picture.at(x, y), shades.page, share * (2 - share)));
        }
    });
}

Image paint_pixels(const grid::GridSpec& spec, const FlatField& field, const ColourTable& table,
                   const ViewGeometry& geometry, const GroundLook& look, int threads) {
    return paint(spec, geometry, look, threads,
                 [&](std::size_t /*column*/, const GroundPatch& patch) {
                     return shade_of(field, field.index(patch.x, patch.y), table, patch, look);
                 });
}

}  // namespace stormcellar::render
