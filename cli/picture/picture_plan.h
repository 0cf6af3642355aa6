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

// The [plan] of a scene's file, and whether the picture of the file is a volume.
struct ScenePlan {
    std::string file;
    std::string tolerance;
    std::vector<std::string> effects;
    bool of_volume = true;
};

// The options as they were typed, or as a scene's file has them.
struct PicturePlanOptions {
    std::string tolerance;
    std::vector<std::string> effects;
    bool tolerance_typed = false, effects_typed = false;
    bool explain = false;
    std::optional<ScenePlan> scene;  // none: no file was given

    [[nodiscard]] bool asked() const { return explain || !tolerance.empty() || !effects.empty(); }
    // nothing was typed in addition to the file
    [[nodiscard]] bool is_scenes() const {
        return scene && !explain && tolerance == scene->tolerance && effects == scene->effects;
    }
};

void add_picture_plan_options(CLI::App& app, PicturePlanOptions& options);

// A number of slices and a plan that chooses it (a tolerance, an effect slices_...) exclude each
// other. Typed options override a scene's file, whose option is then left out. Errors:
// bad_argument, naming both, if both were typed or both are in the file.
[[nodiscard]] Result<PicturePlanOptions> plan_beside_slices(const PicturePlanOptions& plan,
                                                            const SceneOptions& scene);

// Plans for this grid and sets the scene's slices, integration and rays (slices that no tolerance
// or effect chooses stay). Prints the plan if requested: to stderr with `json`, else to stdout.
// Returns what the plan knows about the error of the picture, in one line. Does nothing and returns
// an empty line if nothing was requested. A plan of the scene's file is ignored for a typed product
// that is no volume. Errors: bad_argument for invalid options, or a product that is no volume;
// not_found, naming the best plan, if none meets the tolerance.
[[nodiscard]] Result<std::string> plan_picture(const grid::BrickView& view,
                                               const render::FrameFacts& facts,
                                               const PicturePlanOptions& options, bool json,
                                               int threads, render::Scene& scene);

}  // namespace stormcellar::cli
