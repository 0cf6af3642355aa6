// grid/place/site_columns.h -- from places about a site to the columns of a grid: a gate's way into
// it.
//
// The opposite of stormcellar/grid/column_geometry.h, for many places at once. Columns are smooth
// in the plane about the site (arc times sine and cosine of the azimuth), so they are tabulated
// there every 25 km and linear between; of a grid in the azimuthal equidistant projection about the
// site itself they are the formula. Units    metres, azimuths by their sine and cosine; columns as
// GridProjection has them. Accuracy about the site itself 1e-6 m; else, within `reach_m`, of exact
// geodesics: 5 m for plane
//          projections whose centre is up to 1500 km away, 30 m for latitude_longitude up to 60
//          degrees and 90 m up to 75 (beyond that, and around the whole earth, each place is solved
//          exactly). Enforced by tests/grid/site_columns_test.cpp.
// Threads  immutable.
#pragma once

#include <vector>

#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {

class SiteColumns {
  public:
    SiteColumns(const SitePosition& site, const GridSpec& spec, double reach_m);

    // The arc must be within the reach.
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
    int nodes_ = 0;  // along each side of the table, from -reach
    double first_m_ = 0;
    std::vector<ColumnPoint> table_;
};

}  // namespace stormcellar::grid
