#include "stormcellar/accuracy/plan.h"

#include <algorithm>

#include <fmt/format.h>

namespace stormcellar::accuracy {
namespace {

struct Situation {
    const Chain& chain;
    const Budget& budget;
    const Candidate& candidate;
    Outcome outcome = Outcome::met;
};

bool is_empty(const Budget& budget) {
    return !budget.bounds_errors() && !budget.time_s;
}

// The result of lowering a step until one of its effects and all effects above that effect are off:
// the error that is left off, and the time that is saved.
struct Lowered {
    ErrorSize left_off;
    double saved_s = 0;
};

Lowered without(const Situation& situation, std::size_t at, std::size_t index) {
    Lowered lowered{situation.candidate.left_off, 0};
    Choice choice = situation.candidate.choice;
    for (std::size_t k = index; k < choice.rungs[at]; ++k)
        lowered.left_off += situation.chain.steps[at].effects[k].predicted;
    const double cost_with_s = cost_s(situation.chain, choice);
    choice.rungs[at] = index;
    lowered.saved_s = std::max(0.0, cost_with_s - cost_s(situation.chain, choice));
    return lowered;
}

// Returns the reason why effect `index` of step `at` is on.
std::string reason_on(const Situation& situation, std::size_t at, std::size_t index) {
    const Step& step = situation.chain.steps[at];
    const Effect& effect = step.effects[index];
    if (effect.setting == Setting::on) return "set on";
    if (is_empty(situation.budget)) return "by default";
    const std::size_t least = allowed_rungs(step).least;
    if (index < least)
        return fmt::format("{} needs it, which is set on", step.effects[least - 1].name);
    if (is_unbounded(effect.predicted)) return "how much it matters has no bound";
    const Lowered lowered = without(situation, at, index);
    for (const Quantity quantity : all_quantities) {
        const auto limit = situation.budget.limit(quantity);
        const double sum = lowered.left_off.of(quantity);
        if (!limit || sum <= *limit) continue;
        return fmt::format("without it {} would be left off, of {} allowed",
                           format_quantity(quantity, sum, situation.chain.value_unit),
                           format_quantity(quantity, *limit, situation.chain.value_unit));
    }
    if (lowered.saved_s == 0) return "costs nothing";
    if (!situation.budget.bounds_errors()) return "there is time for it";
    return situation.outcome == Outcome::met ? "no cheaper choice was shown to be good enough"
                                             : "the budget is not met, this is the best";
}

std::string reason_off(const Situation& situation, const Step& step, std::size_t index) {
    const Effect& effect = step.effects[index];
    if (effect.setting == Setting::off) return "set off";
    if (effect.setting == Setting::not_asked) return "the scene does not ask for it";
    const std::size_t most = allowed_rungs(step).most;
    if (most <= index) return fmt::format("needs {}, which is set off", step.effects[most].name);
    if (effect.predicted == ErrorSize{}) return "changes nothing here";
    if (is_empty(situation.budget)) return "off by default, no tolerance was stated";
    if (!situation.budget.bounds_errors()) return "there is no time for it";
    if (!within(situation.candidate.left_off, situation.budget)) return "there is no time for it";
    return "small: all that is left off is within the budget";
}

}  // namespace

std::optional<double> Measured::of(Quantity quantity) const {
    return figure_of(quantity, position_m, value, image_de);
}

Plan make_plan(const Chain& chain, const Budget& budget, const Candidate& candidate,
               Outcome outcome) {
    const Situation situation{chain, budget, candidate, outcome};
    Plan plan;
    plan.budget = budget;
    plan.value_unit = chain.value_unit;
    plan.choice = candidate.choice;
    plan.description = describe(chain, candidate.choice);
    plan.meets_budget = outcome == Outcome::met;
    plan.left_off = candidate.left_off;
    plan.cost_s = candidate.cost_s;
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const Step& step = chain.steps[i];
        const std::size_t rung = candidate.choice.rungs[i];
        for (std::size_t k = 0; k < step.effects.size(); ++k) {
            const Effect& effect = step.effects[k];
            Decision decision;
            decision.effect = effect.name;
            decision.what = effect.what;
            decision.step = step.name;
            decision.on = k < rung;
            decision.is_asked = effect.setting != Setting::not_asked;
            decision.predicted = effect.predicted;
            decision.evidence = effect.evidence;
            decision.share = worst_share(effect.predicted, budget);
            decision.reason =
                decision.on ? reason_on(situation, i, k) : reason_off(situation, step, k);
            plan.decisions.push_back(std::move(decision));
        }
    }
    return plan;
}

}  // namespace stormcellar::accuracy
