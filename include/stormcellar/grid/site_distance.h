// stormcellar/grid/site_distance.h -- computes how far the columns of a window are from a site,
// with few geodesics.
//
// Merging (stormcellar/grid/mosaic.h) needs the square of the arc to each column. The square is
// smooth. So the constructor solves geodesics only at nodes, which neighboring patches of columns
// share; inside a patch the square is a polynomial of second degree in both directions through the
// patch's nodes. Nodes are 8, 4 or 2 columns apart: the widest spacing that keeps the accuracy. If
// even 2 columns are too wide, every column is a node. The constructor checks patches where their
// error peaks: all patches, or about one in 16 if there are many.
//
// A window of 460 km about a site at 1 km takes 15,000 geodesics (some 20 ms) and 0.1 MiB, so make
// a SiteDistance once for a site and keep it.
//
// Units     Meters and square meters.
// Threads   Immutable; any thread may use it.
// Errors    None; the constructor states what it requires.
// Accuracy  Enforced by tests/grid/site_distance_test.cpp for windows that site_window() returns,
//           in all projections, from pole to pole, with cells of 100 m to 50 km: the square of an
//           arc `a` of up to 500 km is off by at most 0.2 m times the larger of `a` and 100 km. An
//           arc beyond 100 km is therefore off by at most 0.1 m.
#pragma once

#include <array>
#include <vector>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::grid {

// The columns of one brick: y runs fastest, as in bricks.
inline constexpr std::size_t brick_columns = 256;
using ColumnValues = std::array<float, brick_columns>;

class SiteDistance {
  public:
    // The domain must be valid, the site must be on the earth, and the window must start at whole
    // bricks.
    SiteDistance(const GridSpec& domain, const GridWindow& window, const SitePosition& site);

    [[nodiscard]] const GridWindow& window() const { return window_; }
    // Returns true if the distances were made for this site's latitude and longitude.
    [[nodiscard]] bool is_of(const SitePosition& site) const;
    // Writes the squares of the arcs to the columns of brick (bx, by) of the domain, in m^2, none
    // below 0. The brick must be in the window. Columns beyond the end of the domain hold
    // meaningless numbers.
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
