// grid/place/site_columns.h -- finds the column of a grid at which a place is. The place, such as a
// gate, is given as seen from a site.
//
// This is the inverse of stormcellar/grid/column_geometry.h, for many places at once. Columns are
// smooth in the plane about the site (arc times sine and cosine of the azimuth). So a table holds
// the column at every 25 km of that plane, and is linear in between. For a grid in the azimuthal
// equidistant projection about the site itself, a formula replaces the table.
//
// Units     Meters; azimuths are passed as sine and cosine; columns are counted as in
//           GridProjection.
// Accuracy  For a grid about the site itself: 1e-6 m. Otherwise, within `reach_m` and against exact
//           geodesics: 5 m for plane projections with a center up to 1500 km away, 30 m for
//           latitude_longitude up to 60 degrees and 90 m up to 75 degrees. For latitude_longitude
//           at sites beyond 75 degrees, or around the whole earth, each place is solved exactly.
//           Enforced by tests/grid/site_columns_test.cpp.
// Threads   Immutable.
#pragma once

#include <vector>

#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {

class SiteColumns {
  public:
    SiteColumns(const SitePosition& site, const GridSpec& spec, double reach_m);

    // Returns the column at which a place is. The arc must be within the reach.
    [[nodiscard]] ColumnPoint at(double sine, double cosine, double arc_m) const;

  private:
    enum class Way { formula, table, exact };

    [[nodiscard]] static Way way_for(const SitePosition& site, const GridSpec& spec);
    [[nodiscard]] ColumnPoint solve(double x_m, double y_m) const;

    Way way_;
    SiteFrame frame_;
    GridProjection projection_;
    double middle_x_, middle_y_, columns_per_m_ = 0;  // of the formula
    double step_m_ = 1;
    int nodes_ = 0;  // along each side of the table, which begins at -reach
    double first_m_ = 0;
    std::vector<ColumnPoint> table_;
};

}  // namespace stormcellar::grid
