// accuracy/governor.h -- makes a plan and checks its promise on the scene itself.
//
// Predictions from a sample can be wrong, and effects can act together. So choices whose predicted
// sums are within the budget are measured by the caller's `measure`, in order of rising effort, and
// the first that meets the budget wins. A choice meets a limit
//   by proof       if every effect left off that touches the quantity has a proven bound (a sample
//                  that shows no effect is no proof),
//   by measuring   if the measured upper bound is within the limit.
// A choice that leaves nothing off, or is proven in every bounded quantity, is not measured. If the
// sample is too small for a bound, the limit is not met, so that no choice passes by luck. After
// all but one of `most_measured` choices have failed, the most accurate choice of all is tried
// instead of the next one.
//
// The time for measuring counts toward a budget's time: a choice is taken only if its cost and the
// time measured so far fit. A budget of a time alone is planned and not measured.
//
// Units     As in stormcellar/accuracy/budget.h.
// Threads   Calls `measure` from the calling thread, one call at a time.
// Errors    Those of plan() and of `measure`. A budget that cannot be met is not an error but a
//           plan (stormcellar/accuracy/plan.h).
#pragma once

#include <functional>
#include <optional>

#include "stormcellar/accuracy/planner.h"

namespace stormcellar::accuracy {

using Measure = std::function<Result<Measured>(const Choice&)>;

struct GovernorOptions {
    std::size_t most_measured = 16;  // 0 counts as 1
    std::function<double()> now_s;   // a monotonic clock; none: the system's
};

[[nodiscard]] Result<Plan> govern(const Chain& chain, const Budget& budget, const Measure& measure,
                                  const GovernorOptions& options = {});

// Returns the plan of one choice without measuring it, for a caller without a budget. Sizes and
// costs are the predictions of the chain.
[[nodiscard]] Plan plan_of_default(const Chain& chain, Choice choice);

// Returns govern() if there is a budget, else the plan of `by_default`.
[[nodiscard]] Result<Plan> govern_or_default(const Chain& chain,
                                             const std::optional<Budget>& budget,
                                             const Choice& by_default, const Measure& measure);

}  // namespace stormcellar::accuracy
