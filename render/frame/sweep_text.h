// render/frame/sweep_text.h -- writes the line about the sweep in the footer of a ppi.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "stormcellar/render/view_geometry.h"

namespace stormcellar::render {

// Returns a text such as "Cut 1: 720 radials, gates of 0.25 km up to 460 km". If a part of the
// circle was not seen, adds the share that was seen. If the view does not show the whole sweep,
// adds the sweep's range.
[[nodiscard]] std::string sweep_text(const grid::SweepLookup& sweep, const grid::GridSpec& spec,
                                     const ViewGeometry& geometry);

}  // namespace stormcellar::render
