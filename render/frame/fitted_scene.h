// render/frame/fitted_scene.h -- gives a scene the view that suits its grids
// (render/view/fitted_camera.h), for the picture inside its labels.
//
// Threads   Pure functions.
#pragma once

#include "render/view/fitted_camera.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/frame_facts.h"

namespace stormcellar::render {

// Fits the view of a volume; for other products the scene does not change. `outline` has the echo
// of all grids that will be seen; `view` and `facts` belong to one of these grids. Errors: those of
// layout_of() and check_frame().
[[nodiscard]] Result<FittedView> fit_scene(const EchoOutline& outline, const grid::BrickView& view,
                                           const FrameFacts& facts, const FitParts& parts,
                                           Scene& scene, bool orbits = false);

}  // namespace stormcellar::render
