// render/options/panel_scenes.h -- makes the scenes for a picture of several moments, as in
// "REF,VEL".
//
// Threads   Pure if `scene_of_panel` is.
// Errors    See panel_scenes().
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "render/options/scene_options.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// The default size of a picture with panels.
inline constexpr int panels_width = 1280, panels_height = 960;

// The moment and the scene of a panel. All panels have the same camera.
struct PanelScene {
    level2::Moment moment = level2::Moment::ref;
    Scene scene;
};

// Returns the moments in a list of panels. Messages call the list by `name`. Errors: bad_argument
// for an unknown or repeated moment.
[[nodiscard]] Result<std::vector<level2::Moment>> moments_of_panels(const std::string& list,
                                                                    std::string_view name);

// Returns the panels for a list of moments. `scene_of_panel` makes the scene of a panel from the
// options with that panel's moment. Errors: bad_argument for an unknown or repeated moment, if a
// moment or colors are given in addition to the panels, and for more panels than a picture may
// have; those of `scene_of_panel`.
[[nodiscard]] Result<std::vector<PanelScene>> panel_scenes(
    const std::string& list, const SceneOptions& options,
    const std::function<Result<Scene>(const SceneOptions&)>& scene_of_panel);

}  // namespace stormcellar::render
