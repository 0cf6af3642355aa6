// stormcellar/grid/grid_spec.h -- the geometry of a grid: where its cells are.
//
// A grid has nx columns from west to east, ny rows from south to north and a list of levels. Cells
// are point samples at their centers, which are symmetrical about the center of the grid: 512
// columns at 1 km have centers at -255.5 ... 255.5 km. Levels are heights above mean sea level. A
// grid is regular either in meters on the plane of its projection, or in degrees of latitude and
// longitude. stormcellar/grid/projection.h converts between columns and places on the earth.
//
// A window of a grid is itself a grid (stormcellar/grid/grid_window.h). A window has the projection
// and the center of the larger grid, but the middle of the window is off the center by
// `offset_*_cells`. The window's columns are exactly at columns of the larger grid, to the bit.
//
// Units     Meters and degrees (WGS84).
// Threads   Plain data and pure functions.
// Errors    See validate(). All other functions expect a valid spec.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::grid {

// The cache's file format contains the numbers of the enumerators, so they do not change.
enum class Projection {
    azimuthal_equidistant = 0,  // about the center, by geodesics of WGS84
    latitude_longitude = 1,     // no projection: rows and columns regular in degrees
    // conic with its origin at the center; true to scale along the parallels
    lambert_conformal = 2,
};

// Facts about a projection besides its formulas, which are in grid/cells/projection.cpp. This is
// the only list of projections; CONTRIBUTING.md says how to add one.
struct ProjectionFacts {
    Projection projection = Projection::azimuthal_equidistant;
    std::string_view name = {};                        // in options, domain files and JSON
    std::array<std::string_view, 2> short_names = {};  // more names on the command line, or empty
    bool in_degrees = false;       // rows and columns are regular in degrees, else in meters
    bool takes_parallels = false;  // true if it has GridSpec::parallels_deg
    bool is_polar = false;         // true to distance and azimuth from the center
};
inline constexpr auto projection_facts = std::to_array<ProjectionFacts>({
    {Projection::azimuthal_equidistant, "azimuthal_equidistant", {"aeqd"}, false, false, true},
    {Projection::latitude_longitude, "latitude_longitude", {"lat-lon", "latlon"}, true},
    {Projection::lambert_conformal, "lambert_conformal", {"lambert", "lcc"}, false, true},
});
inline constexpr ProjectionFacts no_projection = {{}, "unknown", {}};
// Returns the facts of a projection. A number that is no projection (from a damaged file) has the
// facts of `no_projection`.
[[nodiscard]] constexpr const ProjectionFacts& facts_of(Projection projection) {
    const auto at = static_cast<std::size_t>(projection);
    return at < projection_facts.size() ? projection_facts[at] : no_projection;
}
// Returns the name of a projection. The name is the CF grid_mapping_name, such as
// "azimuthal_equidistant", except for lambert_conformal.
[[nodiscard]] constexpr std::string_view projection_name(Projection projection) {
    return facts_of(projection).name;
}
// Finds a projection by its full name.
[[nodiscard]] std::optional<Projection> projection_from_name(std::string_view name);

struct GridSpec {
    static constexpr int greatest_side = 16384;  // columns or rows
    static constexpr int greatest_level_count = 1024;

    Projection projection = Projection::azimuthal_equidistant;
    double center_latitude_deg = 0;
    double center_longitude_deg = 0;
    double spacing_m = 1000;  // 0 for a projection in degrees
    double spacing_deg = 0;   // in both directions; 0 for a projection in meters
    // The standard parallels, which may be equal, for a projection that takes them; else 0.
    std::array<double, 2> parallels_deg{};
    int nx = 460;
    int ny = 460;
    std::vector<double> levels_m;  // strictly rising, at least one
    // The middle of the grid minus its center, in columns to the east and rows to the north;
    // multiples of one half. Both are 0 except in windows of a larger grid.
    double offset_x_cells = 0;
    double offset_y_cells = 0;

    [[nodiscard]] bool in_degrees() const { return facts_of(projection).in_degrees; }
    [[nodiscard]] int nz() const { return static_cast<int>(levels_m.size()); }
    [[nodiscard]] std::size_t column_count() const {
        return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
    }
    [[nodiscard]] std::size_t cell_count() const { return column_count() * levels_m.size(); }

    // These return the size of a column in meters: the spacing, or for a projection in degrees the
    // width or height at the center of the grid. Pictures treat a grid in degrees as a plane.
    [[nodiscard]] double cell_width_m() const {
        return in_degrees() ? width_at_center_m() : spacing_m;
    }
    [[nodiscard]] double cell_height_m() const {
        return in_degrees() ? height_at_center_m() : spacing_m;
    }
    // These return the column and the row of the center, exactly. The center may be between two
    // columns, or outside the grid.
    [[nodiscard]] double center_x() const { return 0.5 * (nx - 1) - offset_x_cells; }
    [[nodiscard]] double center_y() const { return 0.5 * (ny - 1) - offset_y_cells; }
    // These return the center of column ix (meters east of the grid's center) and of row iy (meters
    // north of the grid's center), with columns of cell_width_m() by cell_height_m().
    [[nodiscard]] double x_m(int ix) const { return (ix - center_x()) * cell_width_m(); }
    [[nodiscard]] double y_m(int iy) const { return (iy - center_y()) * cell_height_m(); }
    // These return the center of column ix and of row iy in meters from the middle of the grid,
    // which is the origin in pictures.
    [[nodiscard]] double x_from_middle_m(int ix) const {
        return (ix - 0.5 * (nx - 1)) * cell_width_m();
    }
    [[nodiscard]] double y_from_middle_m(int iy) const {
        return (iy - 0.5 * (ny - 1)) * cell_height_m();
    }

    // Returns the index of a cell in the arrays of a Grid: z runs fastest, then x, then y.
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

// A rectangle of columns of a domain's grid (stormcellar/grid/grid_window.h).
struct GridWindow {
    int first_x = 0;  // column and row of the domain
    int first_y = 0;
    int nx = 0;
    int ny = 0;
    [[nodiscard]] int end_x() const { return first_x + nx; }
    [[nodiscard]] int end_y() const { return first_y + ny; }
    bool operator==(const GridWindow&) const = default;
};

// The length of a degree of longitude and of a degree of latitude on WGS84.
struct DegreeLength {
    double east_m = 0;   // N cos(latitude) per degree; 0 at the poles
    double north_m = 0;  // M per degree
};
[[nodiscard]] DegreeLength degree_length(double latitude_deg) noexcept;

// Returns a spec of 460 x 460 km at 1 km with 32 levels, from 0.5 to 16 km by 0.5 km.
[[nodiscard]] GridSpec default_spec(double center_latitude_deg, double center_longitude_deg);

// Checks a spec. Returns bad_argument unless:
// - there are 1 to 16384 columns, 1 to 16384 rows, 1 to 1024 levels and at most 2^30 cells;
// - the spacing is above 0 and at most 1000 km or 10 degrees, and the center is on the earth;
// - the levels rise strictly within -1 to 60 km;
// - the offsets are multiples of one half, and keep the grid within 16384 by 16384 columns about
//   the center;
// - the projection covers the grid: latitude_longitude ends at the poles and spans at most 360
//   degrees; lambert_conformal has parallels within -89 to 89 degrees that are not opposite, and
//   its grid holds neither a pole nor the cut opposite its central meridian;
// - all fields that the projection does not use are 0.
[[nodiscard]] Status validate(const GridSpec& spec);

}  // namespace stormcellar::grid
