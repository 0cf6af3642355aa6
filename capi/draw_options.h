// capi/draw_options.h -- reads the options of a picture.
//
// Threads   Functions without state.
#pragma once

#include <optional>

#include "render/options/scene_options.h"
#include "stormcellar.h"
#include "stormcellar/base/result.h"

namespace stormcellar::capi {

// Reads the options. `own_moment` is the moment of the grid, which is drawn if no other moment is
// named. Errors: bad_argument, with the name of the option.
[[nodiscard]] Result<render::SceneOptions> scene_options_of(
    const stormcellar_draw_options& options, std::optional<level2::Moment> own_moment);

}  // namespace stormcellar::capi
