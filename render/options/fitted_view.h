// render/options/fitted_view.h -- what a user did not ask for is chosen from the echo: camera,
// exaggeration, opacity, sun and light of a volume's picture (render/view/fitted_camera.h).
//
// What was typed stays. A place of the camera, a zoom and a view with parallel rays each say what
// is in the picture, so beside them no place is fitted. A scene file that has any key of [camera],
// [light] or [volume] says how its volume is seen; what it leaves out then has its usual default.
#pragma once

#include "render/frame/fitted_scene.h"
#include "render/options/scene_options.h"

namespace stormcellar::render {

[[nodiscard]] FitParts parts_to_fit(const SceneOptions& options);
// Returns true if anything of a picture with these options depends on the echo.
[[nodiscard]] bool fits_anything(const SceneOptions& options);
// Returns true if neither the command line nor a scene file says how the volume is lit.
[[nodiscard]] bool chooses_light(const SceneOptions& options);

// Fits the scene to the echo of all grids that will be seen; `view` and `facts` are of one of them.
// `orbits` says that the camera will move around the echo. If `last` is not null and has a view
// that still suits, that one is taken; the view that is taken is left there. Errors: those of
// fit_scene().
[[nodiscard]] Result<FittedView> fit_picture(const EchoOutline& outline,
                                             const grid::BrickView& view, const FrameFacts& facts,
                                             const SceneOptions& options, Scene& scene,
                                             bool orbits = false,
                                             std::optional<FittedView>* last = nullptr);

}  // namespace stormcellar::render
