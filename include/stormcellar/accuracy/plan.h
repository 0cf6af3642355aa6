// stormcellar/accuracy/plan.h -- the planner's choice, and the reason why each effect is on or off.
//
// There is a plan even if nothing meets the budget. The plan then holds the best choice, and
// `shortfall` names this choice, its error and the settings that prevent a better choice.
//
// Units     Times are in seconds; values are in `value_unit`; the units of sizes are in
//           stormcellar/accuracy/quantity.h.
// Threads   Plans are plain values and all functions are pure.
// Errors    None.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stormcellar/accuracy/candidate.h"
#include "stormcellar/accuracy/error_statistics.h"

namespace stormcellar::accuracy {

struct Decision {
    std::string effect;
    std::string what;  // Effect::what
    std::string step;
    bool on = false;
    bool is_asked = true;  // false for Setting::not_asked, which does not count as left off
    ErrorSize predicted;
    Evidence evidence = Evidence::sample;
    double share = 0;    // worst_share() of this effect alone, on or off
    std::string reason;  // plain words without a period at the end
};

// The result of measuring a choice on a sample: upper bounds against the exact form of the chain. A
// bound is none if it was not measured or the sample was too small. If all effects that touch a
// quantity have proven sizes, a plan replaces the missing bound of this quantity by the sum of
// these sizes.
struct Measured {
    std::optional<double> position_m;
    std::optional<double> value;  // bounds the 99th percentile (accuracy/quantile_bound.h)
    std::optional<double> image_de;
    StatusCounts status;  // reported; no budget bounds it

    // Returns the bound for one quantity, or none.
    [[nodiscard]] std::optional<double> of(Quantity quantity) const;
};

struct Plan {
    Budget budget;
    ValueUnit value_unit = ValueUnit::db;
    Choice choice;
    std::string description;  // describe() of the choice
    bool meets_budget = false;
    std::string shortfall;            // empty if the budget is met
    ErrorSize left_off;               // left_off() of the choice
    double cost_s = 0;                // predicted, without the measuring
    std::vector<Decision> decisions;  // in the order of the steps

    std::optional<Measured> measured;  // for `choice`; none if it was not measured
    std::size_t measured_choices = 0;  // number of choices that were measured
    double measuring_s = 0;            // time that measuring took
};

enum class Outcome { met, unmet };

// Makes the plan for a candidate. `outcome` says whether the candidate meets the budget; the
// reasons depend on `outcome`. If the budget is empty, the candidate is the default. The caller
// adds the shortfall and the measurements.
[[nodiscard]] Plan make_plan(const Chain& chain, const Budget& budget, const Candidate& candidate,
                             Outcome outcome);

}  // namespace stormcellar::accuracy
