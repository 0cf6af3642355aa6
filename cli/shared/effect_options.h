// cli/shared/effect_options.h -- the options that choose how exactly to grid, and their parsed
// form.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/shared/commands.h"
#include "grid/plan/grid_effects.h"
#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/mosaic.h"
#include "stormcellar/grid/refractivity.h"

namespace stormcellar::cli {

inline constexpr std::string_view default_profile = "exponential";

// The options as they were typed.
struct EffectOptions {
    std::string method;
    std::string averaging;
    std::vector<std::string> effects;
    std::string tolerance;
    std::string profile{default_profile};
    std::string time_method;  // only for several volumes, where add_mosaic_options() adds it
    bool explain = false;
};

void add_effect_options(CLI::App& app, EffectOptions& options);

struct EffectRequest {
    accuracy::Chain chain;  // with the requested settings
    grid::Averaging averaging = grid::Averaging::in_db;
    std::optional<accuracy::Budget> budget;
    grid::RefractivityProfile profile = grid::RefractivityProfile::reference();
    // Height of the first level, if the profile is a sounding.
    std::optional<double> sounding_from_m;
    // A profile was given, but refraction is off, so it has no effect.
    bool profile_bends_nothing = false;
    bool explain = false;

    // Returns true if errors and times must be predicted for the scene, because of a budget or
    // --explain.
    [[nodiscard]] bool needs_plan() const { return budget.has_value() || explain; }
};

// Parses the options. A profile other than the default turns refraction on, unless refraction is
// set explicitly or a tolerance leaves it to the planner. For several volumes, returns the chain of
// their mosaic (pipeline/mosaic/mosaic_effects.h), whose sites overlap by the given rule. Errors:
// bad_argument, naming the option; io and permission for a sounding that cannot be read.
[[nodiscard]] Result<EffectRequest> parse_effects(
    const EffectOptions& options, level2::Moment moment,
    std::optional<grid::Overlap> overlap = std::nullopt);

}  // namespace stormcellar::cli
