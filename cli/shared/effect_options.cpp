#include "cli/shared/effect_options.h"

#include <algorithm>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "base/name_list.h"
#include "grid/beam/sounding.h"
#include "pipeline/mosaic/mosaic_effects.h"
#include "stormcellar/accuracy/effect.h"

namespace stormcellar::cli {
namespace {

using accuracy::EffectOverride;
using accuracy::Setting;

constexpr std::string_view standard_profile = "standard";

// The settings of effects that the name of a method means.
using Settings = std::vector<EffectOverride>;

// Returns the settings of each method. A method of interpolation turns its own effect on and the
// next effect off.
const std::map<std::string, Settings>& methods() {
    static const std::map<std::string, Settings> known = [] {
        const accuracy::Chain chain = grid::effects_of(level2::Moment::ref);
        const std::size_t step = accuracy::find_step(chain, grid::step::interpolation).value();
        const std::vector<accuracy::Effect>& effects = chain.steps[step].effects;
        std::map<std::string, Settings> made;
        for (const grid::InterpolationFacts& facts : grid::interpolation_facts) {
            const auto rung = static_cast<std::size_t>(facts.interpolation);
            Settings& settings = made[std::string(facts.name)];
            if (rung > 0) settings.push_back({effects[rung - 1].name, Setting::on});
            if (rung < effects.size()) settings.push_back({effects[rung].name, Setting::off});
            settings.push_back({"cell_size", Setting::off});
        }
        made["area"] = {{effects.back().name, Setting::on}, {"cell_size", Setting::on}};
        return made;
    }();
    return known;
}

const std::map<std::string, Settings>& time_methods() {
    static const std::map<std::string, Settings> known = {
        {"nearest", {{"time_blend", Setting::off}}},
        {"blend", {{"time_blend", Setting::on}, {"echo_motion", Setting::off}}},
        {"advected", {{"echo_motion", Setting::on}}},
    };
    return known;
}

Result<Settings> settings_of(const std::map<std::string, Settings>& known, std::string_view option,
                             const std::string& name) {
    if (name.empty()) return Settings{};
    if (const auto method = known.find(name); method != known.end()) return method->second;
    std::vector<std::string> names;
    names.reserve(known.size());
    for (const auto& [one, ignored] : known)
        names.push_back(one);
    return fail(ErrorCode::bad_argument, "{} takes one of {}, not '{}'", option,
                fmt::join(names, ", "), name);
}

Result<Settings> settings_of_methods(const EffectOptions& options) {
    auto settings = settings_of(methods(), "--method", options.method);
    if (!settings) return settings;
    auto time = settings_of(time_methods(), "--time-method", options.time_method);
    if (!time) return time;
    settings->insert(settings->end(), time->begin(), time->end());
    return settings;
}

// Returns the settings as text, for example "column_interpolation on, cell_size off".
std::string text_of(const Settings& settings) {
    std::vector<std::string> parts;
    parts.reserve(settings.size());
    for (const EffectOverride& set : settings)
        parts.push_back(fmt::format("{} {}", set.name, set.setting == Setting::on ? "on" : "off"));
    return fmt::format("{}", fmt::join(parts, ", "));
}

Status set_effects(const EffectOptions& options, accuracy::Chain& chain) {
    auto by_method = settings_of_methods(options);
    if (!by_method) return pass_on(by_method);
    const auto names = accuracy::effect_names(chain);
    Settings settings;
    for (const std::string& text : options.effects) {
        const auto setting = accuracy::parse_override(text, names);
        if (!setting) return fail(setting.error().code, "--effect: {}", setting.error().message);
        settings.push_back(*setting);
    }
    accuracy::Chain by_name = chain;
    if (auto set = accuracy::apply_overrides(by_name, settings); !set) return set;
    // An effect that is set explicitly overrides the setting of the method.
    std::erase_if(*by_method, [&](const EffectOverride& set) {
        return std::any_of(settings.begin(), settings.end(),
                           [&](const EffectOverride& named) { return named.name == set.name; });
    });
    settings.insert(settings.end(), by_method->begin(), by_method->end());
    if (auto set = accuracy::apply_overrides(chain, settings); !set) {
        const bool both = !options.method.empty() && !options.time_method.empty();
        return fail(set.error().code, "{} ({}{}{} {} {})", set.error().message,
                    options.method.empty() ? "" : "--method " + options.method, both ? " and " : "",
                    options.time_method.empty() ? "" : "--time-method " + options.time_method,
                    both ? "set" : "sets", text_of(*by_method));
    }
    return {};
}

Result<grid::Averaging> parse_averaging(const std::string& text, level2::Moment moment) {
    if (text.empty() || text == "db" || text == "dB") return grid::Averaging::in_db;
    if (text != "z" && text != "Z") {
        return fail(ErrorCode::bad_argument, "--averaging takes dB or Z, not '{}'", text);
    }
    if (moment != level2::Moment::ref) {
        return fail(ErrorCode::bad_argument, "--averaging Z works only with REF");
    }
    return grid::Averaging::in_z;
}

Result<grid::RefractivityProfile> parse_profile(const std::string& text) {
    if (text == default_profile) return grid::RefractivityProfile::reference();
    if (text == standard_profile) return grid::RefractivityProfile::standard(45);
    auto sounding = grid::read_sounding(text);
    if (sounding) return sounding;
    // If the name is unknown or the file has no sounding, the user typed something wrong.
    const ErrorCode code = sounding.error().code;
    const bool unreadable = code == ErrorCode::io || code == ErrorCode::permission;
    return fail(unreadable ? code : ErrorCode::bad_argument,
                "--profile takes exponential, standard or a sounding file: {}",
                sounding.error().message);
}

// Turns refraction on if a profile was given, unless another option sets refraction.
void bend_by_profile(EffectRequest& request) {
    for (accuracy::Step& step : request.chain.steps) {
        for (accuracy::Effect& effect : step.effects) {
            if (effect.name != "refraction") continue;
            const bool may_be_on = accuracy::allowed_rungs(step).most == step.effects.size();
            if (may_be_on) effect.setting = Setting::on;
            request.profile_bends_nothing = !may_be_on;
        }
    }
}

Status take_profile(const EffectOptions& options, EffectRequest& request) {
    auto profile = parse_profile(options.profile);
    if (!profile) return pass_on(profile);
    request.profile = std::move(*profile);
    if (options.profile == default_profile) return {};
    const bool is_sounding = options.profile != standard_profile;
    if (is_sounding) request.sounding_from_m = request.profile.layer(0).top_m;
    if (!request.budget) bend_by_profile(request);
    return {};
}

}  // namespace

Result<EffectRequest> parse_effects(const EffectOptions& options, level2::Moment moment,
                                    std::optional<grid::Overlap> overlap) {
    EffectRequest request;
    const auto averaging = parse_averaging(options.averaging, moment);
    if (!averaging) return pass_on(averaging);
    request.averaging = *averaging;
    request.chain = overlap ? pipeline::mosaic_effects_of(moment, *averaging, *overlap)
                            : grid::effects_of(moment, *averaging);
    request.explain = options.explain;
    if (auto set = set_effects(options, request.chain); !set) return pass_on(set);
    if (!options.tolerance.empty()) {
        auto budget = accuracy::parse_budget(options.tolerance);
        if (!budget) {
            return fail(budget.error().code, "--tolerance: {}", budget.error().message);
        }
        const accuracy::ValueUnit unit = grid::value_unit_of(moment);
        if (budget->value && budget->value_unit != unit) {
            return fail(ErrorCode::bad_argument, "--tolerance: {} is in {}, not in {}",
                        level2::moment_name(moment), accuracy::name_of(unit),
                        accuracy::name_of(budget->value_unit));
        }
        if (budget->image_de) {
            return fail(ErrorCode::bad_argument,
                        "--tolerance: a grid has no colors; dE is for pictures");
        }
        request.budget = *budget;
    }
    if (auto taken = take_profile(options, request); !taken) return pass_on(taken);
    return request;
}

void add_effect_options(CLI::App& app, EffectOptions& options) {
    app.add_option("--method", options.method,
                   fmt::format("How gates become a cell: {} or area. Default: linear",
                               names_in(grid::interpolation_facts)));
    app.add_option("--averaging", options.averaging,
                   "Unit in which REF is averaged: dB (the default) or Z");
    app.add_option("--effect", options.effects,
                   "Turn an effect on or off, or let the plan decide: NAME=on|off|auto. The option "
                   "may be given several times; --explain lists the effects");
    app.add_option("--tolerance", options.tolerance,
                   "Allowed error against the exact chain, as in \"250 m, 0.5 dB\", or allowed "
                   "time, as in \"200 ms\". The cheapest effects that meet it are chosen");
    app.add_option("--profile", options.profile,
                   "Profile of refractivity: exponential, standard or a sounding file. A profile "
                   "other than the default turns the effect refraction on, unless --effect sets it "
                   "or --tolerance is given")
        ->capture_default_str();
    app.add_flag("--explain", options.explain,
                 "Print how large each effect is here, whether it is on, and why");
}

}  // namespace stormcellar::cli
