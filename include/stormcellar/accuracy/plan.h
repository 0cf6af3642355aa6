// stormcellar/accuracy/plan.h -- the choice of the planner, and the reason for each effect's
// setting.
//
// There is a plan even if nothing meets the budget. It then holds the best choice, and one line,
// `shortfall`, names that choice, its error and the settings in the way.
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
    std::string what;  // the sentence of the effect
    std::string step;
    bool on = false;
    bool is_asked = true;  // false for Setting::not_asked, which never counts as left off
    ErrorSize predicted;
    Evidence evidence = Evidence::sample;
    // worst_share() of this effect alone, whether it is left off or not
    double share = 0;
    std::string reason;  // plain words without a full stop
};

// The result of measuring a choice on a sample: upper bounds against the exact form of the chain. A
// bound is none if the sample was too small to give one. In a plan, proven sums replace bounds that
// were not measured.
struct Measured {
    std::optional<double> position_m;
    std::optional<double> value;  // bounds the 99th percentile (accuracy/quantile_bound.h)
    std::optional<double> image_de;
    StatusCounts status;  // reported, not budgeted

    // Returns the bound for one kind of error, or none.
    [[nodiscard]] std::optional<double> of(Quantity quantity) const;
};

struct Plan {
    Budget budget;
    ValueUnit value_unit = ValueUnit::db;
    Choice choice;
    std::string description;  // describe() of the choice
    bool meets_budget = false;
    std::string shortfall;            // empty if the budget is met
    ErrorSize left_off;               // sum of the predictions of the effects that are off
    double cost_s = 0;                // predicted, without the time for measuring
    std::vector<Decision> decisions;  // in the order of the chain

    std::optional<Measured> measured;  // for `choice`
    std::size_t measured_choices = 0;  // how many choices were measured
    double measuring_s = 0;            // the time that measuring took
};

enum class Outcome { met, unmet };

// Makes the plan for a candidate. The reasons depend on `outcome`, which says whether the candidate
// meets the budget. An empty budget means that the candidate is the default. The caller adds the
// shortfall and the measurements.
[[nodiscard]] Plan make_plan(const Chain& chain, const Budget& budget, const Candidate& candidate,
                             Outcome outcome);

}  // namespace stormcellar::accuracy
