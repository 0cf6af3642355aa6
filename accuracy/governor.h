// accuracy/governor.h -- makes a plan and checks on the scene itself that the plan keeps the
// budget.
//
// Predictions from a sample can be wrong, and effects can act together. So govern() tries the
// choices whose predicted sums are within the budget, in order of rising effort. It calls the
// caller's `measure` for each choice and returns the first choice that meets the budget. A choice
// meets the limit of a quantity
//   by proof       if each effect that is left off and touches the quantity has a proven bound (a
//                  sample that shows no effect is no proof), or
//   by measuring   if the measured upper bound is within the limit.
// A choice that is proven in every bounded quantity is not measured. If the sample is too small for
// a bound, the limit counts as not met, so that no choice passes by luck. At most `most_measured`
// choices are tried. If more choices fit by prediction, the last choice tried is the most accurate
// of all.
//
// The time for measuring counts toward a budget's time: a choice is taken only if its cost plus the
// time already spent on measuring is within the budget's time. If the budget bounds only the time,
// nothing is measured.
//
// Units     As in stormcellar/accuracy/budget.h.
// Threads   Calls `measure` from the calling thread, one call at a time.
// Errors    Those of plan() and of `measure`. If no choice meets the budget, the result is a plan
//           that says so (stormcellar/accuracy/plan.h).
#pragma once

#include <functional>
#include <optional>

#include "stormcellar/accuracy/planner.h"

namespace stormcellar::accuracy {

using Measure = std::function<Result<Measured>(const Choice&)>;

struct GovernorOptions {
    std::size_t most_measured = 16;  // 0 counts as 1
    std::function<double()> now_s;   // a monotonic clock; null: monotonic_s()
};

[[nodiscard]] Result<Plan> govern(const Chain& chain, const Budget& budget, const Measure& measure,
                                  const GovernorOptions& options = {});

// Returns the plan for a choice without measuring it. Call it if there is no budget. Sizes and
// costs are the predictions of the chain.
[[nodiscard]] Plan plan_of_default(const Chain& chain, Choice choice);

// Returns govern() if there is a budget, else plan_of_default() of the choice `by_default`.
[[nodiscard]] Result<Plan> govern_or_default(const Chain& chain,
                                             const std::optional<Budget>& budget,
                                             const Choice& by_default, const Measure& measure);

}  // namespace stormcellar::accuracy
