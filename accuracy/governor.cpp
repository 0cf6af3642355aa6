#include "accuracy/governor.h"

#include <algorithm>

#include <fmt/format.h>

#include "accuracy/timing.h"

namespace stormcellar::accuracy {
namespace {

// Returns true if the size of the effect is known only from a sample. Even if the sample shows no
// effect, other cells may have one: in a sparse scene, 1 of 8 cells was off by 1.4 dB, but none of
// the sampled cells was. Positions are computed from the geometry, so an effect with position size
// 0 moves no cell.
bool rests_on_sample(const Effect& effect, Quantity quantity) {
    if (effect.evidence != Evidence::sample) return false;
    return quantity != Quantity::position || effect.predicted.position_m > 0;
}

// Returns true if the sum of the effects that the choice leaves off is known without a sample.
bool is_proven(const Chain& chain, const Choice& choice, Quantity quantity) {
    for (std::size_t i = 0; i < chain.steps.size(); ++i) {
        const std::vector<Effect>& effects = chain.steps[i].effects;
        for (std::size_t k = choice.rungs[i]; k < effects.size(); ++k) {
            if (effects[k].setting == Setting::not_asked) continue;
            if (rests_on_sample(effects[k], quantity)) return false;
        }
    }
    return true;
}

// Returns the quantities that the budget bounds and whose sums are not proven, so that measuring
// must check them.
std::vector<Quantity> unproven(const Chain& chain, const Budget& budget, const Choice& choice) {
    std::vector<Quantity> quantities;
    for (const Quantity quantity : all_quantities) {
        if (budget.limit(quantity) && !is_proven(chain, choice, quantity)) {
            quantities.push_back(quantity);
        }
    }
    return quantities;
}

bool shown(const Measured& measured, const Budget& budget, const std::vector<Quantity>& needed) {
    return std::all_of(needed.begin(), needed.end(), [&](Quantity quantity) {
        const auto bound = measured.of(quantity);
        return bound && *bound <= *budget.limit(quantity);
    });
}

// Returns the measurement. If it lacks the bound of a quantity whose sum is proven, the proven sum
// takes the bound's place.
Measured with_proofs(const Chain& chain, const Candidate& candidate, Measured measured) {
    const auto fill = [&](Quantity quantity, std::optional<double>& bound) {
        if (bound || !is_proven(chain, candidate.choice, quantity)) return;
        bound = candidate.left_off.of(quantity);
    };
    fill(Quantity::position, measured.position_m);
    fill(Quantity::value, measured.value);
    fill(Quantity::image, measured.image_de);
    return measured;
}

// Returns at most `most` candidates whose predicted sums fit the budget, in order of rising effort.
// If more candidates fit, the most accurate of all takes the last place.
std::vector<Candidate> to_try(const std::vector<Candidate>& candidates, const Budget& budget,
                              std::size_t most) {
    std::vector<Candidate> good;
    for (const Candidate& candidate : candidates) {
        const bool in_time = !budget.time_s || candidate.cost_s <= *budget.time_s;
        if (in_time && within(candidate.left_off, budget)) good.push_back(candidate);
    }
    if (good.size() <= most) return good;
    const Candidate exact =
        *std::min_element(good.begin(), good.end(), [&](const Candidate& a, const Candidate& b) {
            if (is_more_accurate(a.left_off, b.left_off, budget)) return true;
            return !is_more_accurate(b.left_off, a.left_off, budget) && a.off < b.off;
        });
    good.resize(most);
    const bool present = std::any_of(good.begin(), good.end(), [&](const Candidate& candidate) {
        return candidate.choice == exact.choice;
    });
    if (!present) good.back() = exact;
    return good;
}

std::string describe_measured(const Measured& measured, const Budget& budget, ValueUnit unit) {
    std::string text;
    for (const Quantity quantity : all_quantities) {
        if (!budget.limit(quantity)) continue;
        if (!text.empty()) text += ", ";
        const auto bound = measured.of(quantity);
        text +=
            bound ? format_quantity(quantity, *bound, unit) : "an unknown size (too few samples)";
    }
    return text;
}

// Tries candidates in turn, and keeps the best measurement.
class Trial {
  public:
    Trial(const Chain& chain, const Budget& budget, const Measure& measure,
          const GovernorOptions& options)
        : chain_(chain),
          budget_(budget),
          measure_(measure),
          now_s_(options.now_s ? options.now_s : monotonic_s) {}

    [[nodiscard]] bool in_time(const Candidate& candidate) const {
        return !budget_.time_s || candidate.cost_s + measuring_s_ <= *budget_.time_s;
    }

    // Returns the plan if the candidate meets the budget, else none.
    Result<std::optional<Plan>> attempt(const Candidate& candidate) {
        const auto needed = unproven(chain_, budget_, candidate.choice);
        if (needed.empty()) return finish(candidate, Outcome::met, std::nullopt);
        const double start_s = now_s_();
        auto measured = measure_(candidate.choice);
        measuring_s_ += now_s_() - start_s;
        ++count_;
        if (!measured) return pass_on(measured);
        if (shown(*measured, budget_, needed) && in_time(candidate)) {
            return finish(candidate, Outcome::met, *measured);
        }
        keep_best(candidate, *measured, needed);
        return std::nullopt;
    }

    // Returns the plan of the best measured candidate, although that candidate does not meet the
    // budget. Returns none if nothing was measured.
    [[nodiscard]] std::optional<Plan> best() const {
        if (!best_) return std::nullopt;
        Plan plan = finish(*best_, Outcome::unmet, best_measured_);
        plan.shortfall = fmt::format(
            "no choice was shown to meet the budget of {}: the best measured, {}, errs by up to {} "
            "and "
            "takes {} after {} of measuring{}",
            format_budget(budget_), plan.description,
            describe_measured(*plan.measured, budget_, chain_.value_unit),
            format_seconds(plan.cost_s), format_seconds(measuring_s_), settings_in_the_way());
        return plan;
    }

  private:
    Plan finish(const Candidate& candidate, Outcome outcome,
                const std::optional<Measured>& measured) const {
        Plan plan = make_plan(chain_, budget_, candidate, outcome);
        if (measured) plan.measured = with_proofs(chain_, candidate, *measured);
        plan.measured_choices = count_;
        plan.measuring_s = measuring_s_;
        return plan;
    }

    // Keeps the candidate if it is the best so far. Any known error is better than an unknown
    // error.
    void keep_best(const Candidate& candidate, const Measured& measured,
                   const std::vector<Quantity>& needed) {
        ErrorSize size;
        bool known = true;
        for (const Quantity quantity : needed) {
            const auto bound = measured.of(quantity);
            known = known && bound.has_value();
            ErrorSize one;
            if (quantity == Quantity::position) one.position_m = bound.value_or(0);
            if (quantity == Quantity::value) one.value = bound.value_or(0);
            if (quantity == Quantity::image) one.image_de = bound.value_or(0);
            size += one;
        }
        const bool better =
            !best_ || (known && (!best_known_ || is_more_accurate(size, best_size_, budget_)));
        if (!better) return;
        best_ = candidate;
        best_measured_ = measured;
        best_known_ = known;
        best_size_ = size;
    }

    // Returns the end of the shortfall's text, which names the effects that the user set to off.
    [[nodiscard]] std::string settings_in_the_way() const {
        std::string text;
        for (const Step& step : chain_.steps) {
            for (const Effect& effect : step.effects) {
                if (effect.setting != Setting::off) continue;
                text += text.empty() ? "; set off: " : ", ";
                text += effect.name;
            }
        }
        return text;
    }

    const Chain& chain_;
    const Budget& budget_;
    const Measure& measure_;
    std::function<double()> now_s_;
    double measuring_s_ = 0;
    std::size_t count_ = 0;
    std::optional<Candidate> best_;
    Measured best_measured_;
    bool best_known_ = false;
    ErrorSize best_size_;
};

}  // namespace

Result<Plan> govern(const Chain& chain, const Budget& budget, const Measure& measure,
                    const GovernorOptions& options) {
    auto planned = plan(chain, budget);
    if (!planned || !planned->meets_budget || !budget.bounds_errors()) return planned;
    const auto candidates = list_candidates(chain);
    if (!candidates) return pass_on(candidates);

    Trial trial(chain, budget, measure, options);
    const std::size_t most = std::max<std::size_t>(1, options.most_measured);
    for (const Candidate& candidate : to_try(*candidates, budget, most)) {
        if (!trial.in_time(candidate)) continue;
        auto attempted = trial.attempt(candidate);
        if (!attempted) return pass_on(attempted);
        if (*attempted) return **std::move(attempted);
    }
    if (auto best = trial.best()) return *std::move(best);
    // The planner found a choice that fits by prediction, so at least one candidate was within the
    // time.
    return fail(ErrorCode::internal, "the governor tried nothing");
}

Plan plan_of_default(const Chain& chain, Choice choice) {
    Candidate candidate;
    candidate.left_off = left_off(chain, choice);
    candidate.cost_s = cost_s(chain, choice);
    candidate.choice = std::move(choice);
    return make_plan(chain, {}, candidate, Outcome::met);
}

Result<Plan> govern_or_default(const Chain& chain, const std::optional<Budget>& budget,
                               const Choice& by_default, const Measure& measure) {
    if (!budget) return plan_of_default(chain, by_default);
    return govern(chain, *budget, measure);
}

}  // namespace stormcellar::accuracy
