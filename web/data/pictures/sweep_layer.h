// web/data/pictures/sweep_layer.h -- the sweeps of a station as layers of a map.
//
// A layer is "ppi" and a moment, as in "ppi.VEL"; "ppi" alone means REF. Any moment can be named,
// because the gates come from the raw volume.
//
// Threads   Pure functions.
// Errors    See each function.
#pragma once

#include <string_view>

#include "stormcellar/base/result.h"
#include "web/data/pictures/frame_style.h"
#include "web/data/pictures/map_product.h"

namespace stormcellar::web {

struct SweepLayer {
    FrameStyle frame;  // chooses the sweep
    MapStyle map;      // colors it
};

[[nodiscard]] bool is_sweep_layer(std::string_view name);

// Returns true for the options that a layer of sweeps takes as parameters: colors, elevation,
// sweep, dealias, storm-motion, quality, and for HCA freezing-levels.
[[nodiscard]] bool is_of_sweep_layers(const render::PictureOption& option);

// Reads the layer. Gates are never smoothed. Errors: not_found for an unknown moment; bad_argument
// for a parameter that makes no sense.
[[nodiscard]] Result<SweepLayer> sweep_layer(std::string_view name, const Fields& query);

}  // namespace stormcellar::web
