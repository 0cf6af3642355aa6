#include "stormcellar/accuracy/chain.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace stormcellar::accuracy {
namespace {

bool is_size(double number) {
    return !std::isnan(number) && !std::signbit(number);
}

Status validate_effect(const Effect& effect) {
    if (!is_effect_name(effect.name)) {
        return fail(ErrorCode::bad_argument, "\"{}\" cannot be the name of an effect", effect.name);
    }
    for (const Quantity quantity : all_quantities) {
        if (!is_size(effect.predicted.of(quantity))) {
            return fail(ErrorCode::bad_argument, "effect {} predicts a size that is not a size",
                        effect.name);
        }
    }
    if (!is_size(effect.cost_s) || std::isinf(effect.cost_s)) {
        return fail(ErrorCode::bad_argument, "effect {} has a cost that is not a time",
                    effect.name);
    }
    return {};
}

// Checks the effects that are set on. All lower effects of the same step must be allowed to be on.
Status validate_settings(const Step& step) {
    const RungRange range = allowed_rungs(step);
    if (range.least <= range.most) return {};
    return fail(ErrorCode::bad_argument, "{}=on needs {}, which is off",
                step.effects[range.least - 1].name, step.effects[range.most].name);
}

Status validate_joint_costs(const Chain& chain) {
    for (const JointCost& joint : chain.joint_costs) {
        const auto is_there = [&](std::size_t step, std::size_t rung) {
            return step < chain.steps.size() && rung < chain.steps[step].rung_count();
        };
        const bool good = std::isfinite(joint.cost_s) && is_there(joint.step, joint.rung) &&
                          is_there(joint.other_step, joint.other_rung) &&
                          joint.step != joint.other_step;
        if (!good) {
            return fail(ErrorCode::bad_argument,
                        "a joint cost does not belong to two rungs, or is no time");
        }
    }
    return {};
}

// Returns `cheapest` plus the figures of all effects that are on and of all joint costs. A negative
// sum counts as 0.
template <class Figure>
double sum_over(const Chain& chain, const Choice& choice, double cheapest, const Figure& figure) {
    double sum = cheapest;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        for (std::size_t k = 0; k < choice.rungs[i]; ++k)
            sum += figure(chain.steps[i].effects[k]);
    }
    for (const JointCost& joint : chain.joint_costs) {
        const bool both = choice.rungs[joint.step] == joint.rung &&
                          choice.rungs[joint.other_step] == joint.other_rung;
        if (both) sum += figure(joint);
    }
    return std::max(0.0, sum);
}

}  // namespace

std::optional<std::size_t> find_step(const Chain& chain, std::string_view name) {
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        if (chain.steps[i].name == name) return i;
    }
    return std::nullopt;
}

std::size_t rung_of(const Chain& chain, const Choice& choice, std::string_view name) {
    const auto step = find_step(chain, name);
    return step ? choice.rungs[*step] : 0;
}

Choice with_rung(Choice choice, std::size_t step, std::size_t rung) {
    choice.rungs[step] = rung;
    return choice;
}

const std::string& Step::rung_name(std::size_t rung) const {
    return rung == 0 ? cheapest : effects.at(rung - 1).rung;
}

double cost_s(const Chain& chain, const Choice& choice) {
    return sum_over(chain, choice, chain.cheapest_cost_s,
                    [](const auto& part) { return part.cost_s; });
}

double effort(const Chain& chain, const Choice& choice) {
    return sum_over(chain, choice, 0, [](const auto& part) { return part.effort; });
}

ErrorSize left_off(const Chain& chain, const Choice& choice) {
    ErrorSize sum;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        for (std::size_t k = choice.rungs[i]; k < chain.steps[i].effects.size(); ++k) {
            const Effect& effect = chain.steps[i].effects[k];
            if (effect.setting != Setting::not_asked) sum += effect.predicted;
        }
    }
    return sum;
}

RungRange allowed_rungs(const Step& step) {
    RungRange range{0, step.effects.size()};
    for (std::size_t i = step.effects.size(); i > 0; --i) {
        const Setting setting = step.effects[i - 1].setting;
        if (setting == Setting::off || setting == Setting::not_asked) range.most = i - 1;
    }
    for (std::size_t i = 0; i < step.effects.size(); ++i) {
        if (step.effects[i].setting == Setting::on) range.least = i + 1;
    }
    return range;
}

Choice exact_choice(const Chain& chain) {
    Choice exact;
    for (const Step& step : chain.steps) {
        const auto is_asked = [](const Effect& effect) {
            return effect.setting != Setting::not_asked;
        };
        const auto first_unasked =
            std::find_if_not(step.effects.begin(), step.effects.end(), is_asked);
        exact.rungs.push_back(static_cast<std::size_t>(first_unasked - step.effects.begin()));
    }
    return exact;
}

Status validate(const Chain& chain) {
    std::set<std::string> steps;
    std::set<std::string> effects;
    if (!is_size(chain.cheapest_cost_s) || std::isinf(chain.cheapest_cost_s)) {
        return fail(ErrorCode::bad_argument, "the chain has a cost that is not a time");
    }
    for (const Step& step : chain.steps) {
        if (!is_effect_name(step.name) || !steps.insert(step.name).second) {
            return fail(ErrorCode::bad_argument,
                        "\"{}\" cannot be the name of a step, or is there twice", step.name);
        }
        for (const Effect& effect : step.effects) {
            if (auto valid = validate_effect(effect); !valid) return pass_on(valid);
            if (!effects.insert(effect.name).second) {
                return fail(ErrorCode::bad_argument, "effect {} is there twice", effect.name);
            }
        }
        if (auto valid = validate_settings(step); !valid) return pass_on(valid);
    }
    return validate_joint_costs(chain);
}

std::vector<std::string> effect_names(const Chain& chain) {
    std::vector<std::string> names;
    for (const Step& step : chain.steps) {
        for (const Effect& effect : step.effects)
            names.push_back(effect.name);
    }
    return names;
}

Status apply_overrides(Chain& chain, std::span<const EffectOverride> overrides) {
    Chain changed = chain;
    std::set<std::string> seen;
    for (const EffectOverride& wanted : overrides) {
        if (!seen.insert(wanted.name).second) {
            return fail(ErrorCode::bad_argument, "effect {} is set twice", wanted.name);
        }
        bool found = false;
        for (Step& step : changed.steps) {
            for (Effect& effect : step.effects) {
                if (effect.name != wanted.name) continue;
                effect.setting = wanted.setting;
                found = true;
            }
        }
        if (!found) return fail(ErrorCode::bad_argument, "there is no effect \"{}\"", wanted.name);
    }
    if (auto valid = validate(changed); !valid) return pass_on(valid);
    chain = std::move(changed);
    return {};
}

std::string describe(const Chain& chain, const Choice& choice) {
    std::string text;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        if (i > 0) text += ", ";
        text += fmt::format("{}: {}", chain.steps[i].name,
                            chain.steps[i].rung_name(choice.rungs.at(i)));
    }
    return text;
}

}  // namespace stormcellar::accuracy
