// render/frame/fitted_scene.h -- fits the view of a scene to its grids
// (render/view/fitted_camera.h). The view fills the part of the picture that the labels leave.
//
// Threads   Pure functions.
#pragma once

#include "render/view/fitted_camera.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/frame_facts.h"

namespace stormcellar::render {

// Fits the view of a volume. Does not change the scene of another product. `outline` has the echo
// of all grids that will be shown; `view` and `facts` are those of one of these grids. Errors:
// those of layout_of() and check_frame().
[[nodiscard]] Result<FittedView> fit_scene(const EchoOutline& outline, const grid::BrickView& view,
                                           const FrameFacts& facts, const FitParts& parts,
                                           Scene& scene, bool orbits = false);

}  // namespace stormcellar::render
