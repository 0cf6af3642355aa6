// stormcellar/grid/site_distance.h -- computes how far the columns of a window are from a site,
// with few geodesics.
//
// Merging (stormcellar/grid/mosaic.h) needs the square of the arc to each column, and that square
// is smooth. So geodesics are solved exactly only at nodes, which neighboring patches of columns
// share; inside a patch the square is a polynomial of second degree in both directions through its
// nodes. Nodes are 8, 4 or 2 columns apart, as the stated accuracy needs; if 2 is too far, every
// column is a node. The constructor checks patches where their error peaks: all patches, or one in
// 16 if there are many.
//
// A window of 460 km about a site at 1 km takes 15,000 geodesics (some 20 ms) and 0.1 MiB, so it is
// made once for a site and kept.
//
// Units     Meters and square meters.
// Threads   Immutable; any thread may use it.
// Errors    None; see the constructor for what it requires.
// Accuracy  Enforced by tests/grid/site_distance_test.cpp for all projections, from pole to pole,
//           with cells of 100 m to 50 km, where the window is a site_window(): the square of an arc
//           `a` of up to 500 km is off by at most 0.2 m times the larger of `a` and 100 km. An arc
//           beyond 100 km is therefore off by at most 0.1 m.
#pragma once

#include <array>
#include <vector>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::grid {

// The columns of one brick, from west to east, and from south to north within each, as cells lie in
// a brick.
inline constexpr std::size_t brick_columns = 256;
using ColumnValues = std::array<float, brick_columns>;

class SiteDistance {
  public:
    // The domain must be valid, the site must be on the earth, and the window must start at whole
    // bricks.
    SiteDistance(const GridSpec& domain, const GridWindow& window, const SitePosition& site);

    [[nodiscard]] const GridWindow& window() const { return window_; }
    // Returns true if the distances were made for the position of this site.
    [[nodiscard]] bool is_of(const SitePosition& site) const;
    // Writes the squares of the arcs to the columns of brick (bx, by) of the domain, in m^2, none
    // below 0. The brick must lie in the window. Columns beyond the end of the domain hold 0 or a
    // continuation.
    void squared_arcs_m2(int bx, int by, ColumnValues& to) const;
    [[nodiscard]] std::size_t node_count() const { return nodes_.size(); }

  private:
    GridWindow window_;
    double latitude_deg_, longitude_deg_;
    int step_ = 8;               // columns from one node to the next
    int nodes_y_ = 0;            // nodes in a column of nodes
    std::vector<double> nodes_;  // y runs fastest
};

}  // namespace stormcellar::grid
