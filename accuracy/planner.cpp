#include "stormcellar/accuracy/planner.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace stormcellar::accuracy {
namespace {

bool in_time(const Candidate& candidate, const Budget& budget) {
    return !budget.time_s || candidate.cost_s <= *budget.time_s;
}

// Returns the most accurate candidate within the time. If several are equally accurate, returns the
// first, which has the least effort.
const Candidate* most_accurate_in_time(const std::vector<Candidate>& candidates,
                                       const Budget& budget) {
    const Candidate* best = nullptr;
    for (const Candidate& candidate : candidates) {
        if (!in_time(candidate, budget)) continue;
        if (best == nullptr || is_more_accurate(candidate.left_off, best->left_off, budget)) {
            best = &candidate;
        }
    }
    return best;
}

// Returns the size with 0 in all quantities that the budget does not bound.
ErrorSize bounded_part(const ErrorSize& size, const Budget& budget) {
    ErrorSize part;
    if (budget.position_m) part.position_m = size.position_m;
    if (budget.value) part.value = size.value;
    if (budget.image_de) part.image_de = size.image_de;
    return part;
}

}  // namespace

Status validate(const Chain& chain, const Budget& budget) {
    if (!budget.bounds_errors() && !budget.time_s) {
        return fail(ErrorCode::bad_argument, "the budget sets no limit");
    }
    if (budget.value && budget.value_unit != chain.value_unit) {
        return fail(ErrorCode::bad_argument, "the budget is in {}, but the values are in {}",
                    name_of(budget.value_unit), name_of(chain.value_unit));
    }
    return validate(chain);
}

std::string settings_in_the_way(const Chain& chain, const Budget& budget,
                                const Candidate& candidate) {
    const bool too_much_off = !within(candidate.left_off, budget);
    const bool too_slow = !in_time(candidate, budget);
    std::vector<std::string> off;
    std::vector<std::string> on;
    for (const Step& step : chain.steps) {
        for (const Effect& effect : step.effects) {
            const bool counts = !(bounded_part(effect.predicted, budget) == ErrorSize{});
            if (effect.setting == Setting::off && too_much_off && counts) {
                off.push_back(effect.name);
            }
            if (effect.setting == Setting::on && too_slow && effect.cost_s > 0) {
                on.push_back(effect.name);
            }
        }
    }
    std::string text;
    if (!off.empty()) text += fmt::format("; set off: {}", fmt::join(off, ", "));
    if (!on.empty()) text += fmt::format("; set on: {}", fmt::join(on, ", "));
    return text;
}

Result<Plan> plan(const Chain& chain, const Budget& budget) {
    if (auto valid = validate(chain, budget); !valid) return pass_on(valid);
    const auto candidates = list_candidates(chain);
    if (!candidates) return pass_on(candidates);

    const Candidate* best = nullptr;
    if (budget.bounds_errors()) {
        const auto first =
            std::find_if(candidates->begin(), candidates->end(), [&](const Candidate& candidate) {
                return in_time(candidate, budget) && within(candidate.left_off, budget);
            });
        if (first != candidates->end()) best = &*first;
    } else {
        best = most_accurate_in_time(*candidates, budget);
    }
    if (best != nullptr) return make_plan(chain, budget, *best, Outcome::met);

    best = most_accurate_in_time(*candidates, budget);
    if (best == nullptr) best = &candidates->front();
    Plan unmet = make_plan(chain, budget, *best, Outcome::unmet);
    unmet.shortfall = fmt::format(
        "no choice meets the budget of {}: the best, {}, leaves off {} and takes {}{}",
        format_budget(budget), unmet.description, format_size(best->left_off, chain.value_unit),
        format_seconds(best->cost_s), settings_in_the_way(chain, budget, *best));
    return unmet;
}

}  // namespace stormcellar::accuracy
