// accuracy/governor.h -- a plan whose promise is checked on the scene itself.
//
// Predictions by sample can be wrong, and effects can act together. So choices whose predicted sums
// are within the budget are measured, in order of rising effort, by the caller's `measure`; the
// first that meets the budget wins. A limit is met by a choice
//   by proof       when every effect left off that touches the quantity is exact or a proven bound
//   by measuring   when the measured upper bound is within it
// A choice that leaves nothing off, or is proven in every bounded quantity, is not measured: that
// costs nothing. Where the sample is too small for a bound, the limit is not met: never by luck.
// When `most_measured` choices have failed but one, the most accurate of all is tried instead of
// the rest.
//
// What measuring takes counts into a budget's time: a choice is taken only if its cost and
// the time measured so far fit. A budget of a time alone is planned and not measured.
// Errors: as plan(), and those of `measure`. A budget that is not met is a plan
// (stormcellar/accuracy/plan.h). Thread contract: calls `measure` from the calling thread, one at a
// time.
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

// The plan of one choice as it is, met and not measured: what a caller without a budget gets of its
// default. Sizes and costs are the chain's predictions.
[[nodiscard]] Plan plan_of_default(const Chain& chain, Choice choice);

// With a budget what govern() finds, without one the plan of `by_default`.
[[nodiscard]] Result<Plan> govern_or_default(const Chain& chain,
                                             const std::optional<Budget>& budget,
                                             const Choice& by_default, const Measure& measure);

}  // namespace stormcellar::accuracy
