#include "stormcellar/accuracy/candidate.h"

#include <algorithm>
#include <limits>

namespace stormcellar::accuracy {
namespace {

Candidate evaluate(const Chain& chain, const Choice& choice) {
    Candidate candidate;
    candidate.choice = choice;
    candidate.cost_s = cost_s(chain, choice);
    candidate.effort = effort(chain, choice);
    candidate.left_off = left_off(chain, choice);
    for (std::size_t i = 0; i < chain.steps.size(); ++i)
        candidate.off += chain.steps[i].effects.size() - choice.rungs[i];
    return candidate;
}

// Returns true if the chain has efforts. Without efforts, only measured costs can order the
// choices.
bool has_efforts(const Chain& chain) {
    for (const Step& step : chain.steps) {
        for (const Effect& effect : step.effects) {
            if (effect.effort > 0) return true;
        }
    }
    return !std::all_of(chain.joint_costs.begin(), chain.joint_costs.end(),
                        [](const JointCost& joint) { return joint.effort == 0; });
}

bool comes_before(const Candidate& a, const Candidate& b, bool by_cost) {
    if (a.effort != b.effort) return a.effort < b.effort;
    if (by_cost && a.cost_s != b.cost_s) return a.cost_s < b.cost_s;
    if (a.off != b.off) return a.off < b.off;
    return a.choice.rungs > b.choice.rungs;
}

// Returns true if the choice leaves off an effect of unbounded size that its settings allow to be
// on.
bool is_reckless(const Chain& chain, const Choice& choice, const std::vector<RungRange>& ranges) {
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        for (std::size_t k = choice.rungs[i]; k < ranges[i].most; ++k) {
            if (is_unbounded(chain.steps[i].effects[k].predicted)) return true;
        }
    }
    return false;
}

// Advances to the next choice within the ranges, like a counter with one digit for each step.
// Returns false after the last choice.
bool advance(Choice& choice, const std::vector<RungRange>& ranges) {
    for (std::size_t i = ranges.size(); i > 0; --i) {
        if (choice.rungs[i - 1] < ranges[i - 1].most) {
            ++choice.rungs[i - 1];
            return true;
        }
        choice.rungs[i - 1] = ranges[i - 1].least;
    }
    return false;
}

constexpr ErrorSize usual{250, 0.5, 2};

double share(double size, double limit) {
    if (size == 0) return 0;
    if (limit == 0) return std::numeric_limits<double>::infinity();
    return size / limit;
}

}  // namespace

Result<std::vector<Candidate>> list_candidates(const Chain& chain) {
    if (auto valid = validate(chain); !valid) return pass_on(valid);
    std::vector<RungRange> ranges;
    Choice choice;
    std::size_t count = 1;
    for (const Step& step : chain.steps) {
        const RungRange range = allowed_rungs(step);
        count *= range.most - range.least + 1;
        if (count > most_candidates) {
            return fail(ErrorCode::unsupported,
                        "there are more than {} choices of effects; set some of them on or off",
                        most_candidates);
        }
        ranges.push_back(range);
        choice.rungs.push_back(range.least);
    }
    std::vector<Candidate> candidates;
    candidates.reserve(count);
    do {
        if (!is_reckless(chain, choice, ranges)) candidates.push_back(evaluate(chain, choice));
    } while (advance(choice, ranges));
    const bool by_cost = !has_efforts(chain);
    std::sort(candidates.begin(), candidates.end(),
              [&](const Candidate& a, const Candidate& b) { return comes_before(a, b, by_cost); });
    return candidates;
}

bool within(const ErrorSize& size, const Budget& budget) {
    return std::all_of(all_quantities.begin(), all_quantities.end(), [&](Quantity quantity) {
        const auto limit = budget.limit(quantity);
        return !limit || size.of(quantity) <= *limit;
    });
}

double worst_share(const ErrorSize& size, const Budget& budget) {
    Budget limits = budget;
    if (!budget.bounds_errors()) {
        limits.position_m = usual.position_m;
        limits.value = usual.value;
        limits.image_de = usual.image_de;
    }
    double worst = 0;
    for (const Quantity quantity : all_quantities) {
        const auto limit = limits.limit(quantity);
        if (limit) worst = std::max(worst, share(size.of(quantity), *limit));
    }
    return worst;
}

bool is_more_accurate(const ErrorSize& a, const ErrorSize& b, const Budget& budget) {
    const double share_a = worst_share(a, budget);
    const double share_b = worst_share(b, budget);
    if (share_a != share_b) return share_a < share_b;
    const auto sum = [](const ErrorSize& size) {
        double total = 0;
        for (const Quantity quantity : all_quantities)
            total += size.of(quantity) / usual.of(quantity);
        return total;
    };
    return sum(a) < sum(b);
}

}  // namespace stormcellar::accuracy
