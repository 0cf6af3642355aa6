// render/options/fitted_view.h -- chooses what the user did not specify from the echo: camera,
// exaggeration, opacity, sun and light of a volume's picture (render/view/fitted_camera.h).
//
// Typed options stay. A place of the camera, a zoom and a view with parallel rays each determine
// what is in the picture, so none of them allows a fitted place. If a scene file has any key of
// [camera], [light] or [volume], it determines how its volume is seen; keys that it leaves out then
// have their usual defaults.
#pragma once

#include "render/frame/fitted_scene.h"
#include "render/options/scene_options.h"

namespace stormcellar::render {

[[nodiscard]] FitParts parts_to_fit(const SceneOptions& options);
// Returns true if anything of a picture with these options depends on the echo.
[[nodiscard]] bool fits_anything(const SceneOptions& options);
// Returns true if neither the command line nor a scene file says how the volume is lit.
[[nodiscard]] bool chooses_light(const SceneOptions& options);

// Fits the scene to the echo of all grids that will be seen; `view` and `facts` belong to one of
// them. `orbits` says that the camera will move around the echo. If `last` is not null and its view
// still suits, that view is taken. The view that is taken is stored there. Errors: those of
// fit_scene().
[[nodiscard]] Result<FittedView> fit_picture(const EchoOutline& outline,
                                             const grid::BrickView& view, const FrameFacts& facts,
                                             const SceneOptions& options, Scene& scene,
                                             bool orbits = false,
                                             std::optional<FittedView>* last = nullptr);

}  // namespace stormcellar::render
