// stormcellar/grid/grid_window.h -- rectangles of columns of a domain's grid, as grids of their
// own.
//
// What one site sees of a large domain is gridded on the domain's own columns, in a window: a
// GridSpec with the same projection, centre and levels, whose columns are at the bit-same places.
// So nothing is interpolated twice, and windows of many sites merge cell by cell
// (stormcellar/grid/mosaic.h). Threads: pure functions.
#pragma once

#include <optional>

#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::grid {

// Which columns of a domain a site is gridded on: beyond the last gate of a WSR-88D.
inline constexpr double site_reach_m = 460000;

// The window must lie within the domain, which may itself be a window of another.
[[nodiscard]] GridSpec window_spec(const GridSpec& domain, const GridWindow& window);

// The opposite; none where the spec's columns are not columns of the domain, or its levels others.
[[nodiscard]] std::optional<GridWindow> window_of(const GridSpec& domain, const GridSpec& spec);

// Whether it starts and ends at whole bricks, or at the domain's end, as merging asks.
[[nodiscard]] bool is_whole_bricks(const GridSpec& domain, const GridWindow& window);

// A window of whole bricks that holds every column of a valid domain within `reach_m` (at most
// 2,000 km) of the site. None where the site reaches no column for certain. It is at most one brick
// a side larger than the smallest, except where the reach holds a pole or what a projection tears
// apart (the antipode of its centre, the cut of a cone, both ends of a grid all round the earth):
// there it may be as wide or as high as the domain.
[[nodiscard]] std::optional<GridWindow> site_window(const GridSpec& domain,
                                                    const SitePosition& site,
                                                    double reach_m = site_reach_m);

}  // namespace stormcellar::grid
