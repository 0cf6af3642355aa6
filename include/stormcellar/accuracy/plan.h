// stormcellar/accuracy/plan.h -- what was chosen, and for each effect why.
//
// A plan is a result even when nothing meets the budget: it then holds the best that there is, and
// one line, `shortfall`, that names it, its error and the settings in the way.
// Thread contract: values and pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stormcellar/accuracy/candidate.h"
#include "stormcellar/accuracy/error_statistics.h"

namespace stormcellar::accuracy {

struct Decision {
    std::string effect;
    std::string what;  // the effect's own sentence
    std::string step;
    bool on = false;
    bool is_asked = true;  // false where Setting::not_asked: no part of what is left off
    ErrorSize predicted;
    Evidence evidence = Evidence::sample;
    double share = 0;    // worst_share() of it alone: what leaving it off takes or would take
    std::string reason;  // plain words, no full stop
};

// What measuring a choice on a sample gave: upper bounds against the chain's exact form, none where
// the sample was too small to give one. In a plan, proven sums stand in for what was not measured.
struct Measured {
    std::optional<double> position_m;
    std::optional<double> value;  // of the 99th percentile (accuracy/quantile_bound.h)
    std::optional<double> image_de;
    StatusCounts status;  // reported, not budgeted

    [[nodiscard]] std::optional<double> of(Quantity quantity) const;
};

struct Plan {
    Budget budget;
    ValueUnit value_unit = ValueUnit::db;
    Choice choice;
    std::string description;  // describe() of the choice
    bool meets_budget = false;
    std::string shortfall;            // empty when the budget is met
    ErrorSize left_off;               // sum of the predictions of what is off
    double cost_s = 0;                // predicted, without measuring
    std::vector<Decision> decisions;  // in the order of the chain

    std::optional<Measured> measured;  // of the choice
    std::size_t measured_choices = 0;  // how many were measured
    double measuring_s = 0;            // and what that took
};

enum class Outcome { met, unmet };

// The plan that a candidate makes; `outcome` says whether it meets the budget, which the reasons
// depend on. An empty budget: the candidate is what is done by default. The caller adds shortfall
// and what was measured.
[[nodiscard]] Plan make_plan(const Chain& chain, const Budget& budget, const Candidate& candidate,
                             Outcome outcome);

}  // namespace stormcellar::accuracy
