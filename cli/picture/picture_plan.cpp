#include "cli/picture/picture_plan.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "accuracy/explain.h"
#include "render/frame/picture_layout.h"
#include "render/options/picture_options.h"
#include "render/plan/volume_plan.h"

namespace stormcellar::cli {
namespace {

struct PictureRequest {
    accuracy::Chain chain;
    std::optional<accuracy::Budget> budget;
};

Result<PictureRequest> parse_plan(const PicturePlanOptions& options, const render::Light& light) {
    PictureRequest request;
    request.chain = render::volume_chain(light);
    std::vector<accuracy::EffectOverride> overrides;
    for (const std::string& text : options.effects) {
        const auto parsed = accuracy::parse_override(text, accuracy::effect_names(request.chain));
        if (!parsed) return fail(parsed.error().code, "--effect: {}", parsed.error().message);
        overrides.push_back(*parsed);
    }
    if (auto set = accuracy::apply_overrides(request.chain, overrides); !set) {
        return fail(set.error().code, "--effect: {}", set.error().message);
    }
    if (!options.tolerance.empty()) {
        auto budget = accuracy::parse_budget(options.tolerance);
        if (!budget) return fail(budget.error().code, "--tolerance: {}", budget.error().message);
        request.budget = *budget;
    }
    return request;
}

render::VolumeChoice choice_of(const render::Scene& scene) {
    return {scene.slices,         scene.integration,  !(scene.pixel_tolerance > 0),
            scene.light.gradient, scene.light.shadow, scene.light.scattering};
}

bool chooses_slices(const std::string& effect) {
    return effect.starts_with("slices_");
}

// Returns true if the number of slices stays as it is, because no requested effect and no tolerance
// chooses it.
bool keeps_slices(const PicturePlanOptions& options) {
    return options.tolerance.empty() &&
           std::none_of(options.effects.begin(), options.effects.end(), chooses_slices);
}

// Returns the default choice, changed by the settings that were typed.
render::VolumeChoice by_default(const accuracy::Chain& chain, const render::Scene& scene) {
    accuracy::Choice choice = render::rungs_of(chain, choice_of(scene));
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const auto range = accuracy::allowed_rungs(chain.steps[i]);
        choice.rungs[i] = std::clamp(choice.rungs[i], range.least, range.most);
    }
    return render::volume_choice(chain, choice);
}

// Describes the plan's error, relative to the most exact picture that the chain can make of this
// grid.
std::string error_text(const accuracy::Plan& plan) {
    std::string text = plan.budget.bounds_errors()
                           ? fmt::format("tolerance {}; ", accuracy::format_budget(plan.budget))
                           : "";
    text += fmt::format("predicted dE {}", accuracy::format_number(plan.left_off.image_de));
    if (plan.measured && plan.measured->image_de) {
        text += fmt::format(", measured at most dE {} at 99 % of the pixels of the first frame",
                            accuracy::format_number(*plan.measured->image_de));
    }
    return fmt::format("{} ({})", text, plan.description);
}

// Handles a plan for a product other than a volume. If --product replaced the volume of a scene
// file, ignores the file's plan. Returns an error for any other plan.
Result<std::string> without_plan(const PicturePlanOptions& options, render::Product product) {
    if (!options.is_scenes()) {
        return fail(
            ErrorCode::bad_argument,
            "--tolerance, --effect and --explain need --product volume; they do not work with {}",
            render::product_name(product));
    }
    if (options.scene->of_volume) return std::string{};
    return fail(ErrorCode::bad_argument,
                "{}: [plan] needs the product volume; it does not work with {}",
                options.scene->file, render::product_name(product));
}

}  // namespace

void add_picture_plan_options(CLI::App& app, PicturePlanOptions& options) {
    const std::string group = "Accuracy of a volume's picture";
    app.add_option(
           "--tolerance", options.tolerance,
           "Allowed error of the picture, as in \"dE 2\" (CIEDE2000, for 99 % of the pixels), or "
           "allowed time, as in \"20 ms\". Slices and rays are chosen to meet it")
        ->group(group)
        ->each([&options](const std::string&) { options.tolerance_typed = true; });
    app.add_option("--effect", options.effects,
                   "Turn an effect on or off, or let the plan decide: NAME=on|off|auto. The option "
                   "may be given several times; --explain lists the effects")
        ->group(group)
        ->each([&options](const std::string&) { options.effects_typed = true; });
    app.add_flag("--explain", options.explain,
                 "Print how large each effect is, and why it is on or off")
        ->group(group);
}

Result<PicturePlanOptions> plan_beside_slices(const PicturePlanOptions& plan,
                                              const SceneOptions& scene) {
    const PictureOption& slices = render::slices_option();
    const bool typed = contains(scene.typed, slices);
    const bool in_file = !typed && contains(scene.in_file, slices);
    PicturePlanOptions kept = plan;
    if (typed && !plan.tolerance_typed) kept.tolerance.clear();
    if (typed && !plan.effects_typed) std::erase_if(kept.effects, chooses_slices);
    if (!typed && (!in_file || plan.tolerance_typed || plan.effects_typed)) return kept;
    if (keeps_slices(kept)) return kept;
    if (typed) {
        return fail(ErrorCode::bad_argument,
                    "{} and --{} cannot be used together: {} the number of slices", slices.option,
                    kept.tolerance.empty() ? "effect slices_..." : "tolerance",
                    kept.tolerance.empty() ? "the effect sets" : "the tolerance chooses");
    }
    return fail(
        ErrorCode::bad_argument,
        "{}: {} and [plan] {} cannot be used together: the plan chooses the number of slices",
        plan.scene ? plan.scene->file : "", key_of(slices),
        kept.tolerance.empty() ? "effects slices_..." : "tolerance");
}

Result<std::string> plan_picture(const grid::BrickView& view, const render::FrameFacts& facts,
                                 const PicturePlanOptions& options, bool json, int threads,
                                 render::Scene& scene) {
    if (!options.asked()) return std::string{};
    if (render::view_of(scene.product) != render::View::volume)
        return without_plan(options, scene.product);
    const auto request = parse_plan(options, scene.light);
    if (!request) return pass_on(request);
    if (auto valid = render::check_frame(view, facts, scene); !valid) return pass_on(valid);
    const auto layout = render::layout_of(view, facts, scene);
    if (!layout) return pass_on(layout);
    render::VolumeScene drawn(view, render::colors_of(scene), scene, layout->width, layout->height,
                              threads);
    const auto planned = render::plan_volume(
        drawn, request->chain, request->budget, by_default(request->chain, scene),
        options.explain ? render::Predicted::all : render::Predicted::asked);
    if (!planned) return pass_on(planned);
    if (options.explain) {
        fmt::print(json ? stderr : stdout, "{}", accuracy::explain(planned->plan));
    }
    if (!planned->plan.meets_budget) return fail(ErrorCode::unmet, "{}", planned->plan.shortfall);
    if (!keeps_slices(options)) {
        scene.slices = planned->choice.slices;
    } else if (options.explain && scene.slices != planned->choice.slices) {
        fmt::print(json ? stderr : stdout,
                   "The picture has the {} slices that you asked for; the plan has {}.\n",
                   scene.slices, planned->choice.slices);
    }
    scene.integration = planned->choice.integration;
    scene.pixel_tolerance = planned->choice.every_pixel ? 0 : render::interpolated_tolerance;
    scene.light.gradient = planned->choice.gradient;
    scene.light.shadow = planned->choice.shadow;
    scene.light.scattering = planned->choice.scattering;
    return error_text(planned->plan);
}

}  // namespace stormcellar::cli
