// cli/picture_plan.h -- how exactly a volume is drawn: --tolerance, --effect and --explain.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/plan.h"
#include "base/result.h"
#include "render/render.h"

namespace CLI {
class App;
}

namespace stormcellar::cli {

// What [plan] of a scene's file says, and whether the picture of the file is a volume.
struct ScenePlan {
    std::string file;
    std::string tolerance;
    std::vector<std::string> effects;
    bool of_volume = true;
};

// As they were typed, or stand in a scene's file.
struct PicturePlanOptions {
    std::string tolerance;
    std::vector<std::string> effects;
    bool explain = false;
    std::optional<ScenePlan> scene;  // none: no file was given

    [[nodiscard]] bool asked() const { return explain || !tolerance.empty() || !effects.empty(); }
    // Nothing was typed beside the file.
    [[nodiscard]] bool is_scenes() const {
        return scene && !explain && tolerance == scene->tolerance && effects == scene->effects;
    }
};

void add_picture_plan_options(CLI::App& app, PicturePlanOptions& options);

// Plans for this grid and sets the scene's slices, integration and rays as planned; prints the plan
// where that was asked for, to stderr with `json`, else to stdout. Gives what the plan knows of the
// picture's error, in one line. Nothing happens, and the line is empty, when nothing was asked.
// A plan of the scene's file is left out for a product that was typed and is no volume.
// Errors: bad_argument for options that make no sense, or a product that is no volume;
// not_found, naming the best there is, where nothing holds the tolerance.
[[nodiscard]] Result<std::string> plan_picture(const grid::BrickView& view,
                                               const render::FrameFacts& facts,
                                               const PicturePlanOptions& options, bool json,
                                               int threads, render::Scene& scene);

}  // namespace stormcellar::cli
