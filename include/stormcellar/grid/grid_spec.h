// stormcellar/grid/grid_spec.h -- the geometry of a grid: where its cells are.
//
// A grid is nx columns west to east, ny rows south to north and a list of levels. Cells are point
// samples at their centres, which lie symmetrically about the grid's centre: 512 columns at 1 km
// have centres at -255.5 ... 255.5 km. Levels are heights above mean sea level. A grid is regular
// in metres of its projection's plane, or in degrees of latitude and longitude. Which column is
// where on the earth: stormcellar/grid/projection.h. Units: metres and degrees (WGS84).
//
// A window of a grid is a grid too: same projection, same centre, and its middle lies off the
// centre by `offset_*_cells` (stormcellar/grid/grid_window.h). Its columns are at the bit-same
// places.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::grid {

// Numbers of the cache's file format: they do not change.
enum class Projection {
    azimuthal_equidistant = 0,  // about the centre, geodesics of WGS84
    latitude_longitude = 1,     // no projection: rows and columns regular in degrees
    lambert_conformal = 2,      // conic, origin at the centre; true to scale along the parallels
};

// What is known of a projection beside its formulas, which grid/cells/projection.cpp has. The one
// list of projections; docs/recipes-facts.md says how to add one.
struct ProjectionFacts {
    Projection projection = Projection::azimuthal_equidistant;
    std::string_view name = {};                        // in options, domain files and JSON
    std::array<std::string_view, 2> short_names = {};  // on the command line too; empty: none
    bool in_degrees = false;       // rows and columns are regular in degrees, else in metres
    bool takes_parallels = false;  // GridSpec::parallels_deg
    bool is_polar = false;         // true to distance and azimuth from the centre
};
inline constexpr auto projection_facts = std::to_array<ProjectionFacts>({
    {Projection::azimuthal_equidistant, "azimuthal_equidistant", {"aeqd"}, false, false, true},
    {Projection::latitude_longitude, "latitude_longitude", {"lat-lon", "latlon"}, true},
    {Projection::lambert_conformal, "lambert_conformal", {"lambert", "lcc"}, false, true},
});
inline constexpr ProjectionFacts no_projection = {{}, "unknown", {}};
// A number of no projection, which a damaged file may hold, has those of `no_projection`.
[[nodiscard]] constexpr const ProjectionFacts& facts_of(Projection projection) {
    const auto at = static_cast<std::size_t>(projection);
    return at < projection_facts.size() ? projection_facts[at] : no_projection;
}
[[nodiscard]] constexpr std::string_view projection_name(Projection projection) {
    return facts_of(projection).name;
}
// By the full name alone.
[[nodiscard]] std::optional<Projection> projection_from_name(std::string_view name);

struct GridSpec {
    static constexpr int greatest_side = 16384;  // columns or rows
    static constexpr int greatest_level_count = 1024;

    Projection projection = Projection::azimuthal_equidistant;
    double center_latitude_deg = 0;
    double center_longitude_deg = 0;
    double spacing_m = 1000;  // of a plane projection; 0 for one in degrees
    double spacing_deg = 0;   // of a projection in degrees, along both; else 0
    // Standard parallels of a projection that takes them, which may be one and the same; else 0.
    std::array<double, 2> parallels_deg{};
    int nx = 460;
    int ny = 460;
    std::vector<double> levels_m;  // strictly rising, at least one
    // Where the grid's middle lies, seen from the centre: columns to the east and rows to the
    // north, in halves. 0 but for windows of a larger grid.
    double offset_x_cells = 0;
    double offset_y_cells = 0;

    [[nodiscard]] bool in_degrees() const { return facts_of(projection).in_degrees; }
    [[nodiscard]] int nz() const { return static_cast<int>(levels_m.size()); }
    [[nodiscard]] std::size_t column_count() const {
        return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
    }
    [[nodiscard]] std::size_t cell_count() const { return column_count() * levels_m.size(); }

    // A column in metres. Of a plane projection this is its spacing; of one in degrees its
    // width and height at the grid's centre, for all that takes the grid as a plane (pictures).
    [[nodiscard]] double cell_width_m() const {
        return in_degrees() ? width_at_center_m() : spacing_m;
    }
    [[nodiscard]] double cell_height_m() const {
        return in_degrees() ? height_at_center_m() : spacing_m;
    }
    // The column and the row of the centre, which may lie between two and beyond the grid. Exact.
    [[nodiscard]] double center_x() const { return 0.5 * (nx - 1) - offset_x_cells; }
    [[nodiscard]] double center_y() const { return 0.5 * (ny - 1) - offset_y_cells; }
    // Centre of column ix (east of the centre) and row iy (north of it), in that plane.
    [[nodiscard]] double x_m(int ix) const { return (ix - center_x()) * cell_width_m(); }
    [[nodiscard]] double y_m(int iy) const { return (iy - center_y()) * cell_height_m(); }
    // The same from the grid's own middle, about which pictures are made.
    [[nodiscard]] double x_from_middle_m(int ix) const {
        return (ix - 0.5 * (nx - 1)) * cell_width_m();
    }
    [[nodiscard]] double y_from_middle_m(int iy) const {
        return (iy - 0.5 * (ny - 1)) * cell_height_m();
    }

    // Index of a cell in the arrays of a Grid: z runs fastest, then x, then y.
    [[nodiscard]] std::size_t index(int ix, int iy, int iz) const {
        return (static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx) +
                static_cast<std::size_t>(ix)) *
                   levels_m.size() +
               static_cast<std::size_t>(iz);
    }
    bool operator==(const GridSpec&) const = default;

  private:
    [[nodiscard]] double width_at_center_m() const;
    [[nodiscard]] double height_at_center_m() const;
};

// A rectangle of columns of a grid (stormcellar/grid/grid_window.h).
struct GridWindow {
    int first_x = 0;  // columns and rows of the domain
    int first_y = 0;
    int nx = 0;
    int ny = 0;
    [[nodiscard]] int end_x() const { return first_x + nx; }
    [[nodiscard]] int end_y() const { return first_y + ny; }
    bool operator==(const GridWindow&) const = default;
};

// How long a degree of longitude and of latitude is on WGS84.
struct DegreeLength {
    double east_m = 0;   // N cos(latitude) per degree; 0 at the poles
    double north_m = 0;  // M per degree
};
[[nodiscard]] DegreeLength degree_length(double latitude_deg) noexcept;

// 460 x 460 km at 1 km, 32 levels from 0.5 to 16 km by 0.5 km.
[[nodiscard]] GridSpec default_spec(double center_latitude_deg, double center_longitude_deg);

// bad_argument unless sizes are 1..16384 by 16384 by 1024, spacing is positive and finite, the
// centre is on the earth, levels rise strictly within -1 to 60 km, offsets are halves that keep the
// grid within one of 16384 by 16384 about the centre, and the projection covers the grid:
// latitude_longitude ends at the poles and spans at most 360 degrees; lambert_conformal has
// parallels within -89 to 89 degrees that are not opposite, and holds neither pole nor the cut
// opposite its central meridian. What a projection does not use must be 0.
[[nodiscard]] Status validate(const GridSpec& spec);

}  // namespace stormcellar::grid
