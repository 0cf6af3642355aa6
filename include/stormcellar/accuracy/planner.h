// stormcellar/accuracy/planner.h -- the cheapest set of effects that keeps what is left off within
// the budget.
//
// Effects stay off only while the SUM of all predictions left off is within the budget, in every
// quantity that it bounds. An effect that the user set off counts into the sum.
//   a budget of errors        the first of list_candidates() whose sums are within it
//   of errors and a time      the same among those whose predicted cost is within the time
//   of a time alone           the most accurate within it (is_more_accurate()), then the cheaper
// When there is none, the best: the most accurate within the time, or the cheapest when none is.
// The search is exhaustive: it is right by construction, for at most most_candidates choices.
// Errors: as list_candidates(); bad_argument for a budget without any limit, or with one in a unit
// that is not the chain's.
// Thread contract: pure functions.
#pragma once

#include "stormcellar/accuracy/plan.h"

namespace stormcellar::accuracy {

[[nodiscard]] Result<Plan> plan(const Chain& chain, const Budget& budget);

// Whether a plan can be made for the budget at all.
[[nodiscard]] Status validate(const Chain& chain, const Budget& budget);

// The settings without which the candidate would leave less off, or cost less; as in "; set off:
// refraction", empty when there are none.
[[nodiscard]] std::string settings_in_the_way(const Chain& chain, const Budget& budget,
                                              const Candidate& candidate);

}  // namespace stormcellar::accuracy
