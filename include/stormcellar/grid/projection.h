// stormcellar/grid/projection.h -- between columns of a grid and places on the earth, for every
// projection.
//
// Units    columns are fractional: (ix, iy) is the centre of column ix in row iy, and beyond the
//          grid the numbers go on. Places are degrees on WGS84.
// Range    to_geo: the grid itself and some columns about it. to_column: the whole earth; a point
//          that the projection cannot show (the far pole of a cone) lies far outside the grid.
//          Longitudes are taken the short way round from the centre's, so a grid goes on across
//          the antimeridian.
// Source   Karney (2013), Algorithms for geodesics; Snyder (1987), Map Projections - A Working
//          Manual, pp 107-109, without its cancellations; both through GeographicLib.
// Threads  a GridProjection is immutable. NaN in, NaN out; nothing throws.
// Accuracy (enforced by tests/grid/projection_test.cpp)
//          round trip: 1e-7 m for centres from pole to pole, grids of up to 4000 km;
//          lambert_conformal against the closed formula in long doubles (Snyder 1987): 1e-6 m.
#pragma once

#include <memory>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/site_frame.h"

namespace GeographicLib {
class LambertConformalConic;
}  // namespace GeographicLib

namespace stormcellar::grid {

// Where a point lies in the columns of a grid.
struct ColumnPoint {
    double x = 0;  // ix at the centre of column ix
    double y = 0;
};

class GridProjection {
  public:
    // The spec must be valid.
    explicit GridProjection(const GridSpec& spec);

    [[nodiscard]] GeoPoint to_geo(ColumnPoint column) const noexcept;
    [[nodiscard]] ColumnPoint to_column(GeoPoint point) const noexcept;

    // The longitude of a place, plus or minus whole turns: within 180 degrees of the centre's, so
    // that it is continuous over the grid.
    [[nodiscard]] double continuous_longitude_deg(double longitude_deg) const noexcept;

    // Of a latitude_longitude grid: the latitude of a row and the continuous longitude of a column.
    [[nodiscard]] double row_latitude_deg(double y) const noexcept;
    [[nodiscard]] double column_longitude_deg(double x) const noexcept;

  private:
    Projection kind_;
    SiteFrame center_;
    double center_latitude_deg_, center_longitude_deg_;
    double spacing_;              // in metres or degrees
    double center_x_, center_y_;  // the centre, in columns
    std::shared_ptr<const GeographicLib::LambertConformalConic> cone_;
    double cone_y_m_ = 0;  // of the centre, from the cone's own origin
};

// Latitude and longitude of a column's centre. For more than a few, make a GridProjection.
[[nodiscard]] GeoPoint column_position(const GridSpec& spec, int ix, int iy);

// What validate() (stormcellar/grid/grid_spec.h) asks of the projection; spacing and centre must be
// valid.
[[nodiscard]] Status validate_projection(const GridSpec& spec);

}  // namespace stormcellar::grid
