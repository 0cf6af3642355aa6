// cli/loop/loop_camera.h -- decides how many frames a loop has, and where the camera is in each.
//
// The camera is fixed, orbits (--orbit), or follows the keys of a scene file ([[loop.camera]],
// render/view/camera_path.h). The center of an orbit is the middle of a fitted view, the point that
// the camera looks at, or the middle of the grid.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "cli/picture/scene_file.h"
#include "render/view/fitted_camera.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// The scene, and the view that was fitted to it.
struct LoopScene {
    render::Scene scene;
    render::FittedView view;
};

[[nodiscard]] bool moves_camera(const LoopSettings& settings);

// Returns the number of frames of a loop, not counting the frames of --ping-pong that go back.
// `grids` must be at least 1. Errors: bad_argument, with advice, if a loop of a single frame should
// move its camera, or if all frames would be the same.
[[nodiscard]] Result<std::size_t> frame_count(const LoopSettings& settings, std::size_t grids);

// Returns a camera for each of `all` frames. If there are keys, the first `there` frames follow
// their path, and the later frames go back along it. An orbit goes on in the same direction through
// all frames. Errors: those of CameraPath::make().
[[nodiscard]] Result<std::vector<render::Camera>> cameras_of(const LoopSettings& settings,
                                                             const LoopScene& shown,
                                                             std::size_t there, std::size_t all);

}  // namespace stormcellar::cli
