// render/frame/sweep_text.h -- what the footer of a ppi says of its sweep.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// Returns "Cut 1: 720 radials, gates of 0.25 km up to 460 km", with how much of the circle was
// seen if that is not all of it, and with the range of the sweep where the view does not show all.
[[nodiscard]] std::string sweep_text(const grid::SweepLookup& sweep, const grid::GridSpec& spec,
                                     const ViewGeometry& geometry);

}  // namespace stormcellar::render
