// cli/loop/loop_camera.h -- how many frames a loop has, and where the camera is in each of them.
//
// The camera stands still, goes around (--orbit), or goes its way between the keys of a scene file
// ([[loop.camera]], render/view/camera_path.h). Around goes it about the middle of what a fitted
// view shows, about the point that it looks at, or about the middle of the grid.
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

// The scene that is drawn, and the view that was fitted to it.
struct LoopScene {
    render::Scene scene;
    render::FittedView view;
};

[[nodiscard]] bool moves_camera(const LoopSettings& settings);

// Returns the number of frames (there, without the way back) of a loop with this many grids, at
// least one. Errors: bad_argument for a camera that would move in a single frame and for frames
// that would all be the same, with what to do.
[[nodiscard]] Result<std::size_t> frame_count(const LoopSettings& settings, std::size_t grids);

// Returns a camera for each of `all` frames. The first `there` follow the path, and the others go
// the same way back. Errors: those of CameraPath::make().
[[nodiscard]] Result<std::vector<render::Camera>> cameras_of(const LoopSettings& settings,
                                                             const LoopScene& shown,
                                                             std::size_t there, std::size_t all);

}  // namespace stormcellar::cli
