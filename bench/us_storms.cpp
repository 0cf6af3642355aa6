#include "bench/us_storms.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stormcellar::bench {
namespace {

// Returns how high storms reach over a column, in meters; none below 0. The same for all sites.
double storm_top_m(int ix, int iy) {
    const auto wave = [](double at) { return std::sin(at); };
    const double field = wave(ix / 97.0) * wave(iy / 71.0) + 0.6 * wave(ix / 31.0 + iy / 43.0) +
                         0.3 * wave(ix / 13.0) * wave(iy / 11.0);
    return 12000 * field - 1500;
}

// Beams of 0.5 and 19.5 degrees over the 4/3 earth.
struct Seen {
    double bottom_m, top_m;
};
Seen seen_at(double arc_m, double altitude_m) {
    constexpr double radius_m = 8.5e6;
    const double fall_m = altitude_m + arc_m * arc_m / (2 * radius_m);
    return {arc_m * 0.0087 + fall_m, arc_m * 0.354 + fall_m};
}

// Facts of all columns of a brick.
struct Column {
    double arc_m = 0;
    double top_m = 0;  // of the storm over it
};
using Columns = std::array<Column, grid::brick_columns>;

Columns columns_of(const grid::SiteDistance& distance, int bx, int by) {
    grid::ColumnValues squared_m2{};
    distance.squared_arcs_m2(bx, by, squared_m2);
    Columns columns;
    for (int c = 0; c < static_cast<int>(grid::brick_columns); ++c) {
        const auto at = static_cast<std::size_t>(c);
        columns[at] = {std::sqrt(static_cast<double>(squared_m2[at])),
                       storm_top_m(bx * 16 + c / 16, by * 16 + c % 16)};
    }
    return columns;
}

std::uint8_t code_of(const Column& column, const Seen& seen, double level_m) {
    if (column.arc_m > grid::site_reach_m || level_m < seen.bottom_m || level_m > seen.top_m)
        return 0;
    const double under_m = column.top_m - level_m;
    if (under_m < 0) return 1;
    return static_cast<std::uint8_t>(70 + std::min(100.0, under_m / 100));
}

}  // namespace

grid::GridSpec us_grid() {
    grid::GridSpec spec = grid::default_spec(37.5, -95);
    spec.projection = grid::Projection::latitude_longitude;
    spec.spacing_m = 0;
    spec.spacing_deg = 0.01;
    spec.nx = 7000;
    spec.ny = 3500;
    // as in MRMS: 0.5 to 3 km by 0.25, to 9 km by 0.5, to 19 km by 1
    spec.levels_m.clear();
    for (int level = 2; level <= 12; ++level)
        spec.levels_m.push_back(250.0 * level);
    for (int level = 7; level <= 18; ++level)
        spec.levels_m.push_back(500.0 * level);
    for (int level = 10; level <= 19; ++level)
        spec.levels_m.push_back(1000.0 * level);
    return spec;
}

grid::BrickGrid us_storms(const grid::GridSpec& domain, const grid::GridWindow& window,
                          const grid::SiteDistance& distance, const grid::SitePosition& site) {
    grid::BrickGrid made(grid::window_spec(domain, window),
                         grid::default_quantization(level2::Moment::ref));
    grid::BricksWriter writer(made);
    const grid::BrickView shape = made.view();
    std::array<std::uint8_t, grid::brick_cells> codes{};
    for (std::size_t brick = 0; brick < shape.bricks.size(); ++brick) {
        const int bz = static_cast<int>(brick) % shape.bricks_z;
        const int by = static_cast<int>(brick) / shape.bricks_z % shape.bricks_y;
        const int bx = static_cast<int>(brick) / shape.bricks_z / shape.bricks_y;
        const grid::BrickExtent extent = grid::brick_extent(made.spec(), bx, by, bz);
        const Columns columns = columns_of(distance, bx + window.first_x / grid::brick_edge,
                                           by + window.first_y / grid::brick_edge);
        codes.fill(0);
        for (int c = 0; c < static_cast<int>(grid::brick_columns); ++c) {
            if (c / 16 >= extent.x || c % 16 >= extent.y) continue;
            const Column& column = columns[static_cast<std::size_t>(c)];
            const Seen seen = seen_at(column.arc_m, site.altitude_m);
            for (int z = 0; z < extent.z; ++z) {
                const int cell = c * 16 + z;
                const int level = bz * 16 + z;
                codes[static_cast<std::size_t>(cell)] =
                    code_of(column, seen, domain.levels_m[static_cast<std::size_t>(level)]);
            }
        }
        writer.put_codes(brick, codes.data(), extent);
    }
    made.finish({&writer, 1});
    return made;
}

}  // namespace stormcellar::bench
