// stormcellar/accuracy/chain.h -- the steps of a chain, each of which is a ladder of rungs from
// cheap to exact.
//
// A step ("frame", "beam", "interpolation", ...) has rungs 0, 1, ...; its last rung is its exact
// form. At rung k, the first k effects of the step are on. The effects of one step are nested: the
// third needs the second. A step with a single rung has no effects, so the planner has nothing to
// decide there. A choice names one rung for each step.
//
// Units     Costs are in seconds. Efforts are in a fixed scale (Effect::effort).
// Threads   Chains are plain values. All functions are pure except apply_overrides(), which changes
//           its chain.
// Errors    Only validate() and apply_overrides() return errors. All other functions expect a valid
//           chain, and a choice with one rung for each of its steps.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/accuracy/effect.h"

namespace stormcellar::accuracy {

struct Step {
    std::string name;
    std::string cheapest;         // name of rung 0, e.g. "sphere"
    std::vector<Effect> effects;  // from rung 0 upward

    [[nodiscard]] std::size_t rung_count() const { return effects.size() + 1; }
    [[nodiscard]] const std::string& rung_name(std::size_t rung) const;
};

// The extra time that two rungs of different steps take together, beyond the sum of the times that
// each takes alone. The extra time is negative if one rung saves work for the other.
struct JointCost {
    std::size_t step = 0, rung = 0;
    std::size_t other_step = 0, other_rung = 0;
    double cost_s = 0;
    double effort = 0;
};

struct Chain {
    std::vector<Step> steps;
    double cheapest_cost_s = 0;  // of the choice with every effect off
    std::vector<JointCost> joint_costs = {};
    ValueUnit value_unit = ValueUnit::db;
};

struct Choice {
    std::vector<std::size_t> rungs;  // one rung for each step
    bool operator==(const Choice&) const = default;
};

// Returns the number of the step with this name, or none if the chain has no such step.
[[nodiscard]] std::optional<std::size_t> find_step(const Chain& chain, std::string_view name);

// Returns the choice's rung at the step with this name, or 0 if the chain has no such step.
[[nodiscard]] std::size_t rung_of(const Chain& chain, const Choice& choice, std::string_view name);

// Returns the choice with one step at another rung.
[[nodiscard]] Choice with_rung(Choice choice, std::size_t step, std::size_t rung);

// Returns the predicted cost of the whole chain: the cost of the choice with every effect off, plus
// the cost of each effect that is on, plus the joint costs. Never negative.
[[nodiscard]] double cost_s(const Chain& chain, const Choice& choice);
// Returns the effort of the whole chain: the effort of each effect that is on, plus the joint
// efforts. Never negative; 0 if every effect is off and no joint effort applies.
[[nodiscard]] double effort(const Chain& chain, const Choice& choice);

// Returns the exact form. In each step, the effects are on up to the first effect that the scene
// does not ask for; that effect and all above it are off.
[[nodiscard]] Choice exact_choice(const Chain& chain);

// Returns the sum of the predicted sizes of the effects that are off, not counting effects that the
// scene does not ask for.
[[nodiscard]] ErrorSize left_off(const Chain& chain, const Choice& choice);

// The rungs that the effects' settings allow, from `least` to `most`.
struct RungRange {
    std::size_t least = 0;
    std::size_t most = 0;
};
[[nodiscard]] RungRange allowed_rungs(const Step& step);

// Checks a chain. Returns bad_argument if a name is invalid or occurs twice; if a size or a cost of
// an effect is NaN or negative; if a cost is infinite; if a joint cost does not belong to two rungs
// of different steps; or if an effect is set on, but an effect below it in the same step cannot be
// on. An infinite size is valid: it means that no bound is known, so no budget lets the effect be
// off.
[[nodiscard]] Status validate(const Chain& chain);

// Returns the names of all effects, in the order of the steps.
[[nodiscard]] std::vector<std::string> effect_names(const Chain& chain);

// Applies the user's settings. After an error the chain is unchanged. Errors: bad_argument for an
// effect that does not exist or is set twice; the errors of validate().
[[nodiscard]] Status apply_overrides(Chain& chain, std::span<const EffectOverride> overrides);

// Returns the choice as text, such as "frame: sphere, beam: ray traced".
[[nodiscard]] std::string describe(const Chain& chain, const Choice& choice);

}  // namespace stormcellar::accuracy
