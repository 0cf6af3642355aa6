// stormcellar/grid/site_distance.h -- how far the columns of a window are from a site, from few
// geodesics.
//
// What merging asks of each column (stormcellar/grid/mosaic.h) is the square of the arc, and that
// is smooth: in patches of columns it is a polynomial of second degree both ways through exact
// geodesics at nodes that neighbouring patches share. Nodes are 8 columns apart, or so much closer
// that patches asked in between (all, or of many one in 16) are as accurate as stated; at worst
// every column is one. A window of 460 km about a site at 1 km takes 15,000 geodesics (some 20 ms)
// and 0.1 MiB, so it is made once for a site and kept. Accuracy: the square of an arc a of up to
// 500 km is off by at most 0.2 m times the larger of a
//           and 100 km, so an arc beyond 100 km by 0.1 m, where the window is a site_window();
//           enforced by tests/grid/site_distance_test.cpp for all projections, from pole to pole,
//           with cells of 100 m to 50 km.
// Threads:  immutable.
#pragma once

#include <array>
#include <vector>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::grid {

// The columns of one brick, west to east and in each south to north, as cells lie in a brick.
inline constexpr std::size_t brick_columns = 256;
using ColumnValues = std::array<float, brick_columns>;

class SiteDistance {
  public:
    // The domain must be valid and the site on the earth; the window starts at whole bricks.
    SiteDistance(const GridSpec& domain, const GridWindow& window, const SitePosition& site);

    [[nodiscard]] const GridWindow& window() const { return window_; }
    // The position that it was made for.
    [[nodiscard]] bool is_of(const SitePosition& site) const;
    // Squares of the arcs to the columns of brick (bx, by) of the domain, m^2, none below 0. It
    // must lie in the window; columns beyond the domain's end are 0 or go on.
    void squared_arcs_m2(int bx, int by, ColumnValues& to) const;
    [[nodiscard]] std::size_t node_count() const { return nodes_.size(); }

  private:
    GridWindow window_;
    double latitude_deg_, longitude_deg_;
    int step_ = 8;               // columns from node to node
    int nodes_y_ = 0;            // in a column of nodes
    std::vector<double> nodes_;  // x slow, y fast
};

}  // namespace stormcellar::grid
