#include "cli/loop/loop_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace stormcellar::cli {
namespace {

using render::Camera;
using render::CameraPath;

// Turns the camera about the point that it looks at.
Camera turned_about_its_point(Camera camera, double by_deg) {
    const render::Eye& middle = *camera.look_at;
    const double turn = by_deg * std::numbers::pi / 180;
    const double east_m = camera.eye->x_m - middle.x_m;
    const double north_m = camera.eye->y_m - middle.y_m;
    // Azimuths are clockwise.
    camera.eye->x_m = middle.x_m + east_m * std::cos(turn) + north_m * std::sin(turn);
    camera.eye->y_m = middle.y_m - east_m * std::sin(turn) + north_m * std::cos(turn);
    return camera;
}

Camera orbiting(const LoopScene& shown, double by_deg) {
    const Camera& camera = shown.scene.camera;
    if (camera.eye && camera.look_at) return turned_about_its_point(camera, by_deg);
    return render::turned(shown.view, by_deg, shown.scene.curved_earth);
}

// Returns the camera with a position. A camera without a position is placed at the distance of the
// fitted view.
Camera placed(const LoopScene& shown, const Camera& camera) {
    if (camera.eye || camera.look_at) return camera;
    render::FittedView view = shown.view;
    view.camera = camera;
    return render::turned(view, 0, shown.scene.curved_earth);
}

// Returns how far along the path frame i is, from 0 to 1. If the path ends where it began, no frame
// is at 1, because that frame would repeat the loop's first frame.
double share_of(const CameraPath& path, std::size_t i, std::size_t there) {
    const std::size_t steps = path.is_closed() ? there : std::max<std::size_t>(there, 2) - 1;
    return static_cast<double>(i) / static_cast<double>(steps);
}

}  // namespace

bool moves_camera(const LoopSettings& settings) {
    return settings.orbit_deg != 0 || !settings.camera.empty();
}

Result<std::size_t> frame_count(const LoopSettings& settings, std::size_t grids) {
    auto frames = static_cast<std::size_t>(settings.frames);
    if (frames == 0 && !settings.camera.empty()) {
        const auto path = CameraPath::make(settings.camera, {});
        if (!path) return pass_on(path);
        const double steps = path->duration_s() * settings.animation.frames_per_second;
        frames = static_cast<std::size_t>(std::clamp(std::round(steps), 1.0, 1e5)) +
                 (path->is_closed() ? 0 : 1);
    }
    if (frames == 0) frames = grids;
    if (frames == 1 && moves_camera(settings)) {
        return fail(
            ErrorCode::bad_argument,
            "the loop has a single frame, so the camera cannot move in it; ask for more, as "
            "with --frames 120, or for more grids");
    }
    if (grids == 1 && frames > 1 && !moves_camera(settings)) {
        return fail(ErrorCode::bad_argument,
                    "there is one grid, so all {} frames would be the same picture; let the camera "
                    "move, as with --orbit 360, or ask for more grids",
                    frames);
    }
    return frames;
}

Result<std::vector<Camera>> cameras_of(const LoopSettings& settings, const LoopScene& shown,
                                       std::size_t there, std::size_t all) {
    std::vector<Camera> cameras;
    if (settings.camera.empty()) {
        const double step_deg =
            settings.orbit_deg / static_cast<double>(std::max<std::size_t>(all, 1));
        for (std::size_t i = 0; i < all; ++i)
            cameras.push_back(orbiting(shown, step_deg * static_cast<double>(i)));
        return cameras;
    }
    Camera usual = shown.scene.camera;
    // The camera is placed from its direction instead.
    if (shown.view.distance_m > 0) usual.eye.reset();
    const auto path = CameraPath::make(settings.camera, usual);
    if (!path) return pass_on(path);
    for (std::size_t i = 0; i < all; ++i) {
        const std::size_t there_at = i < there ? i : 2 * (there - 1) - i;
        cameras.push_back(placed(shown, path->at(share_of(*path, there_at, there))));
    }
    return cameras;
}

}  // namespace stormcellar::cli
