// stormcellar/accuracy/chain.h -- the steps of a chain, each a ladder of rungs from cheap to exact.
//
// A step ("frame", "beam", "interpolation", ...) has rungs 0, 1, ... of which the last is its exact
// form. Rung k is reached with the first k effects of the step on: effects of one step are nested,
// the third needs the second. A step of a single rung has no effects and stands outside the plan.
// A choice names one rung for each step.
// Thread contract: values and pure functions.
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
    std::string cheapest;         // what rung 0 does, e.g. "sphere"
    std::vector<Effect> effects;  // from rung 0 upwards

    [[nodiscard]] std::size_t rung_count() const { return effects.size() + 1; }
    [[nodiscard]] const std::string& rung_name(std::size_t rung) const;
};

// What two rungs of different steps take together beyond what each takes alone; negative where one
// spares the other work.
struct JointCost {
    std::size_t step = 0, rung = 0;
    std::size_t other_step = 0, other_rung = 0;
    double cost_s = 0;
    double effort = 0;
};

struct Chain {
    std::vector<Step> steps;
    double cheapest_cost_s = 0;  // with every effect off
    std::vector<JointCost> joint_costs = {};
    ValueUnit value_unit = ValueUnit::db;
};

struct Choice {
    std::vector<std::size_t> rungs;  // one a step
    bool operator==(const Choice&) const = default;
};

// The number of the step of this name; none where the chain has no such step.
[[nodiscard]] std::optional<std::size_t> find_step(const Chain& chain, std::string_view name);

// The rung that the choice takes of the step of this name; 0 where the chain has no such step.
[[nodiscard]] std::size_t rung_of(const Chain& chain, const Choice& choice, std::string_view name);

// The same choice, but for one step.
[[nodiscard]] Choice with_rung(Choice choice, std::size_t step, std::size_t rung);

// Predicted, of the whole chain: the cheapest, what each effect that is on adds, and what the rungs
// take jointly. Never negative.
[[nodiscard]] double cost_s(const Chain& chain, const Choice& choice);
// The same sum of efforts, the cheapest choice counting as 0.
[[nodiscard]] double effort(const Chain& chain, const Choice& choice);

// The exact form: every effect on that the scene asks for.
[[nodiscard]] Choice exact_choice(const Chain& chain);

// The sum of the predicted sizes of the effects above the choice's rungs, of those asked for.
[[nodiscard]] ErrorSize left_off(const Chain& chain, const Choice& choice);

// The rungs that the effects' settings leave to choose from, both included.
struct RungRange {
    std::size_t least = 0;
    std::size_t most = 0;
};
[[nodiscard]] RungRange allowed_rungs(const Step& step);

// Errors: bad_argument where a name is no name or stands twice, a size or cost is NaN or negative,
// a cost is infinite, a joint cost is of no pair of rungs, or an effect is on whose step has an
// effect below it off. Infinite sizes are good: they say that no bound is known, so that no budget
// lets the effect be off.
[[nodiscard]] Status validate(const Chain& chain);

[[nodiscard]] std::vector<std::string> effect_names(const Chain& chain);

// Sets what the user asked for; the chain is unchanged on errors. Errors: bad_argument for an
// effect that is not there or is named twice, and as validate() has them.
[[nodiscard]] Status apply_overrides(Chain& chain, std::span<const EffectOverride> overrides);

// As in "frame: sphere, beam: ray traced".
[[nodiscard]] std::string describe(const Chain& chain, const Choice& choice);

}  // namespace stormcellar::accuracy
