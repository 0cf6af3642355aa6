#include "cli/picture/drawn_frames.h"

#include <fmt/format.h>
#include <sys/stat.h>

namespace stormcellar::cli {
namespace {

std::string text_of(const std::optional<render::Eye>& place) {
    return place ? fmt::format("{},{},{}", place->x_m, place->y_m, place->height_m) : "-";
}

// Returns a key for the frame, or an empty text if the grid has no file.
std::string key_of(const std::filesystem::path& grid, const render::Scene& scene) {
    struct stat facts {};
    if (::stat(grid.c_str(), &facts) != 0) return {};
    const render::Camera& camera = scene.camera;
    return fmt::format("{} {}.{:09} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", facts.st_ino,
                       facts.st_mtim.tv_sec, facts.st_mtim.tv_nsec, facts.st_size,
                       camera.azimuth_deg, camera.tilt_deg, camera.zoom, camera.field_of_view_deg,
                       text_of(camera.eye), text_of(camera.look_at), scene.vertical_exaggeration,
                       scene.opacity, scene.light.sun_azimuth_deg, scene.slices,
                       static_cast<int>(scene.integration), scene.pixel_tolerance,
                       render::light_names(scene.light)) +
           grid.native();
}

}  // namespace

Result<render::Image> DrawnFrames::frame(const std::filesystem::path& grid,
                                         const render::Scene& scene, const Draw& draw,
                                         const std::string& marks) {
    // Make the key before drawing. If the grid is replaced meanwhile, its next key differs.
    std::string key = key_of(grid, scene);
    if (!key.empty()) key += marks;
    if (const auto found = frames_.find(key); found != frames_.end()) {
        found->second.is_wanted = true;
        return found->second.image;
    }
    auto drawn = draw();
    if (!drawn || key.empty() || bytes_ + drawn->rgba.size() > limit_) return drawn;
    bytes_ += drawn->rgba.size();
    frames_.emplace(key, Kept{*drawn});
    return drawn;
}

void DrawnFrames::next_loop() {
    for (auto at = frames_.begin(); at != frames_.end();) {
        if (std::exchange(at->second.is_wanted, false)) {
            ++at;
        } else {
            bytes_ -= at->second.image.rgba.size();
            at = frames_.erase(at);
        }
    }
}

}  // namespace stormcellar::cli
