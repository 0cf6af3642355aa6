// web/doors/storms/rotation_json.h -- the strongest azimuthal shear of a grid as GeoJSON features.
//
// Threads   Pure functions.
#pragma once

#include "web/doors/api/call.h"

namespace stormcellar::web {

// Adds a Point for each of the strongest maxima (stormcellar/retrieve/shear_peaks.h) of a grid of
// azimuthal shear, by layer. If the grid was audited, each point has the RMS difference between
// the grid and its gates. The grid does not hold the error of the shear itself.
void add_rotation(const OpenGrid& grid, ApiJson& features);

}  // namespace stormcellar::web
