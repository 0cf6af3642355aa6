// grid/grid_spec.h -- the geometry of a grid: where its cells are.
//
// A grid is nx columns west to east, ny rows south to north and a list of levels. Cells are point
// samples at their centres, which lie symmetrically about the grid's centre: 512 columns at 1 km
// have centres at -255.5 ... 255.5 km. Levels are heights above mean sea level.
// Units: metres and degrees (WGS84).
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace stormcellar::grid {

enum class Projection { azimuthal_equidistant };
[[nodiscard]] std::string_view projection_name(Projection projection);

struct GridSpec {
    Projection projection = Projection::azimuthal_equidistant;
    double center_latitude_deg = 0;
    double center_longitude_deg = 0;
    double spacing_m = 1000;
    int nx = 460;
    int ny = 460;
    std::vector<double> levels_m;  // strictly rising, at least one

    [[nodiscard]] int nz() const { return static_cast<int>(levels_m.size()); }
    [[nodiscard]] std::size_t column_count() const {
        return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
    }
    [[nodiscard]] std::size_t cell_count() const { return column_count() * levels_m.size(); }
    // Centre of column ix (east of the centre) and row iy (north of it).
    [[nodiscard]] double x_m(int ix) const { return (ix - 0.5 * (nx - 1)) * spacing_m; }
    [[nodiscard]] double y_m(int iy) const { return (iy - 0.5 * (ny - 1)) * spacing_m; }
    // Index of a cell in the arrays of a Grid: z runs fastest, then x, then y.
    [[nodiscard]] std::size_t index(int ix, int iy, int iz) const {
        return (static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx) +
                static_cast<std::size_t>(ix)) *
                   levels_m.size() +
               static_cast<std::size_t>(iz);
    }
    bool operator==(const GridSpec&) const = default;
};

// 460 x 460 km at 1 km, 32 levels from 0.5 to 16 km by 0.5 km.
[[nodiscard]] GridSpec default_spec(double center_latitude_deg, double center_longitude_deg);

// bad_argument unless sizes are 1..16384 by 16384 by 1024, spacing is positive and finite, the
// centre is on the earth and levels rise strictly within -1 to 60 km.
[[nodiscard]] Status validate(const GridSpec& spec);

}  // namespace stormcellar::grid
