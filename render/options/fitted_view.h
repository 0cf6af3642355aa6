// render/options/fitted_view.h -- fits to the echo those options that the user did not give:
// camera, exaggeration, opacity, sun and light of a volume's picture (render/view/fitted_camera.h).
//
// Options that were typed keep their values. The place of the camera is not fitted if the user
// gives a place, a point to look at, a zoom or parallel rays, because each of these determines what
// is in the picture. If a scene file has any key of [camera], [light] or [volume], nothing is
// fitted; keys that the file lacks then have their usual defaults.
#pragma once

#include "render/frame/fitted_scene.h"
#include "render/options/scene_options.h"

namespace stormcellar::render {

[[nodiscard]] FitParts parts_to_fit(const SceneOptions& options);
// Returns true if a picture with these options depends on the echo.
[[nodiscard]] bool fits_anything(const SceneOptions& options);
// Returns true if neither the command line nor a scene file says how the volume is lit.
[[nodiscard]] bool chooses_light(const SceneOptions& options);

// Fits the scene to the echo of all grids that will be shown; `view` and `facts` are those of one
// of these grids. `orbits` is true if the camera will move around the echo. If `last` holds a view
// that is near the fitted view, the scene gets that view instead. Then stores the view of the scene
// in `last`. Errors: those of fit_scene().
[[nodiscard]] Result<FittedView> fit_picture(const EchoOutline& outline,
                                             const grid::BrickView& view, const FrameFacts& facts,
                                             const SceneOptions& options, Scene& scene,
                                             bool orbits = false,
                                             std::optional<FittedView>* last = nullptr);

}  // namespace stormcellar::render
