// stormcellar/grid/projection.h -- converts between columns of a grid and places on the earth, for
// every projection.
//
// Units     Columns are fractional: (ix, iy) is the center of column ix in row iy. The numbers
//           continue beyond the grid. Places are in degrees on WGS84.
// Range     to_geo() covers the grid and some columns around it. to_column() covers the whole
//           earth; a point that the projection cannot show (the far pole of a cone) is far outside
//           the grid. Longitudes are measured the short way around from the center, so a grid may
//           cross the antimeridian.
// Source    Karney (2013), Algorithms for geodesics; Snyder (1987), Map Projections - A Working
//           Manual, pp 107-109, rearranged so that nothing cancels; both through GeographicLib.
// Threads   A GridProjection is immutable, so any thread may use it.
// Errors    Nothing throws: NaN in, NaN out. validate_projection() returns a Status.
// Accuracy  Enforced by tests/grid/projection_test.cpp. Round trip: 1e-7 m for centers from pole to
//           pole and grids of up to 4000 km. lambert_conformal against the closed formula in long
//           doubles (Snyder 1987): 1e-6 m.
#pragma once

#include <memory>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::grid {

// A place in columns of a grid.
struct ColumnPoint {
    double x = 0;  // ix at the center of column ix
    double y = 0;
};

class GridProjection {
  public:
    // Makes the projection of a valid spec.
    explicit GridProjection(const GridSpec& spec);

    [[nodiscard]] GeoPoint to_geo(ColumnPoint column) const noexcept;
    [[nodiscard]] ColumnPoint to_column(GeoPoint point) const noexcept;

    // Returns the longitude plus or minus whole turns, within 180 degrees of the center's
    // longitude, so that longitudes are continuous over the grid.
    [[nodiscard]] double continuous_longitude_deg(double longitude_deg) const noexcept;

    // These work for a latitude_longitude grid only: they return the latitude of a row, and the
    // continuous longitude of a column.
    [[nodiscard]] double row_latitude_deg(double y) const noexcept;
    [[nodiscard]] double column_longitude_deg(double x) const noexcept;

  private:
    Projection kind_;
    SiteFrame center_;
    double center_latitude_deg_, center_longitude_deg_;
    double spacing_;              // in meters or degrees
    double center_x_, center_y_;  // the center, in columns
    struct Constants;             // numbers that only one kind needs, computed once
    std::shared_ptr<const Constants> constants_;
};

// Returns the latitude and the longitude of a column's center. For more than a few columns, make a
// GridProjection.
[[nodiscard]] GeoPoint column_position(const GridSpec& spec, int ix, int iy);

// Checks the conditions of validate() (stormcellar/grid/grid_spec.h) on the projection; returns
// bad_argument if one fails. Spacing and center must be valid.
[[nodiscard]] Status validate_projection(const GridSpec& spec);

}  // namespace stormcellar::grid
