// cli/picture/picture_plan.h -- how exactly a volume is drawn: --tolerance, --effect and --explain.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/picture/scene_options.h"
#include "stormcellar/accuracy/plan.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/render.h"

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
    bool tolerance_typed = false, effects_typed = false;
    bool explain = false;
    std::optional<ScenePlan> scene;  // none: no file was given

    [[nodiscard]] bool asked() const { return explain || !tolerance.empty() || !effects.empty(); }
    // Nothing was typed beside the file.
    [[nodiscard]] bool is_scenes() const {
        return scene && !explain && tolerance == scene->tolerance && effects == scene->effects;
    }
};

void add_picture_plan_options(CLI::App& app, PicturePlanOptions& options);

// A number of slices and a plan that chooses it (a tolerance, an effect slices_...) exclude each
// other. What was typed wins over a scene's file, of which the other is left out; where both were
// typed, or stand in the file, bad_argument names them.
[[nodiscard]] Result<PicturePlanOptions> plan_beside_slices(const PicturePlanOptions& plan,
                                                            const SceneOptions& scene);

// Plans for this grid and sets the scene's slices, integration and rays as planned (slices that no
// tolerance or effect chooses stay as they are); prints the plan
// where that was asked for, to stderr with `json`, else to stdout. Gives what the plan knows of the
// picture's error, in one line. Nothing happens, and the line is empty, when nothing was asked.
// A plan of the scene's file is left out for a product that was typed and is no volume.
// Errors: bad_argument for options that make no sense, or a product that is no volume;
// unmet, naming the best there is, where nothing holds the tolerance.
[[nodiscard]] Result<std::string> plan_picture(const grid::BrickView& view,
                                               const render::FrameFacts& facts,
                                               const PicturePlanOptions& options, bool json,
                                               int threads, render::Scene& scene);

}  // namespace stormcellar::cli
