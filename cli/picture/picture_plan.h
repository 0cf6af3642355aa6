// cli/picture/picture_plan.h -- plans how exactly a volume is drawn: --tolerance, --effect and
// --explain.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/picture/scene_arguments.h"
#include "cli/shared/commands.h"
#include "stormcellar/accuracy/plan.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/render.h"

namespace stormcellar::cli {

// The [plan] of a scene file, and whether the file draws a volume.
struct ScenePlan {
    std::string file;
    std::string tolerance;
    std::vector<std::string> effects;
    bool of_volume = true;
};

// The options, from the command line or a scene file.
struct PicturePlanOptions {
    std::string tolerance;
    std::vector<std::string> effects;
    bool tolerance_typed = false, effects_typed = false;
    bool explain = false;
    std::optional<ScenePlan> scene;  // none: no scene file was given

    [[nodiscard]] bool asked() const { return explain || !tolerance.empty() || !effects.empty(); }
    // Returns true if the options are exactly the [plan] of the scene file.
    [[nodiscard]] bool is_scenes() const {
        return scene && !explain && tolerance == scene->tolerance && effects == scene->effects;
    }
};

void add_picture_plan_options(CLI::App& app, PicturePlanOptions& options);

// Resolves a conflict between a number of slices and a plan that chooses this number (a tolerance,
// or an effect slices_...). A typed option wins over an option of a scene file. Errors:
// bad_argument, naming both, if both were typed or both are in the file.
[[nodiscard]] Result<PicturePlanOptions> plan_beside_slices(const PicturePlanOptions& plan,
                                                            const SceneOptions& scene);

// Plans for this grid and sets the scene's slices, integration and rays. Keeps the number of slices
// unless a tolerance or an effect chooses it. Prints the plan if requested: to stderr with `json`,
// else to stdout. Returns one line about the expected error of the picture. If no plan was
// requested, does nothing and returns an empty line; this includes the plan of a scene file if a
// product other than a volume was typed. Errors: bad_argument for invalid options, or for a product
// that is not a volume; not_found, naming the best plan, if no plan meets the tolerance.
[[nodiscard]] Result<std::string> plan_picture(const grid::BrickView& view,
                                               const render::FrameFacts& facts,
                                               const PicturePlanOptions& options, bool json,
                                               int threads, render::Scene& scene);

}  // namespace stormcellar::cli
