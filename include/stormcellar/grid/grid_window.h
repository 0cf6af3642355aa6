// stormcellar/grid/grid_window.h -- rectangles of columns of a domain's grid, as grids of their
// own.
//
// The data of one site in a large domain are gridded on columns of the domain, in a window. A
// window is a GridSpec with the domain's projection, center and levels, whose columns are exactly
// columns of the domain, to the bit. So no step interpolates the data again, and the windows of
// many sites can be merged cell by cell (stormcellar/grid/mosaic.h).
//
// Units     Columns and rows; meters for reaches.
// Threads   Pure functions.
// Errors    None; window_of() and site_window() return none where no window fits.
#pragma once

#include <optional>

#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::grid {

// A site is gridded on the columns of a domain up to this distance, which is beyond the last gate
// of a WSR-88D.
inline constexpr double site_reach_m = 460000;

// Returns the spec of a window. The window must be within the domain, which may itself be a window
// of another domain.
[[nodiscard]] GridSpec window_spec(const GridSpec& domain, const GridWindow& window);

// Returns the window of the domain that a spec describes. Returns none if columns of the spec are
// not columns of the domain, or if the levels differ.
[[nodiscard]] std::optional<GridWindow> window_of(const GridSpec& domain, const GridSpec& spec);

// Returns true if the window starts at whole bricks, and ends at whole bricks or with the domain.
// Merging requires this.
[[nodiscard]] bool is_whole_bricks(const GridSpec& domain, const GridWindow& window);

// Returns a window of whole bricks that holds every column of a valid domain within `reach_m` (at
// most 2,000 km) of the site. Returns none if the site certainly reaches no column.
// The window is at most one brick larger on each side than the smallest such window, with one
// exception: if the reach holds a pole or a place that a projection tears apart (the antipode of
// its center, the cut of a cone, both ends of a grid all around the earth), the window may be as
// wide or as high as the domain.
[[nodiscard]] std::optional<GridWindow> site_window(const GridSpec& domain,
                                                    const SitePosition& site,
                                                    double reach_m = site_reach_m);

}  // namespace stormcellar::grid
