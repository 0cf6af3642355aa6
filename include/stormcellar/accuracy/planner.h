// stormcellar/accuracy/planner.h -- finds the cheapest set of effects whose omissions stay within
// the budget.
//
// Effects may stay off only while the SUM of all predictions left off is within the budget, in
// every quantity that the budget bounds. An effect that the user turned off counts in the sum.
//   budget of errors             the first of list_candidates() whose sums are within it
//   budget of errors and a time  the same, among those whose predicted cost is within the time
//   budget of a time alone       the most accurate within it (is_more_accurate()), then the cheaper
// If no candidate fits, the plan holds the best one: the most accurate within the time, or the
// cheapest if none is within the time. The search is exhaustive, for at most most_candidates
// choices, so it cannot miss the best.
//
// Units     As in stormcellar/accuracy/budget.h and chain.h.
// Threads   Pure functions.
// Errors    Those of list_candidates(); bad_argument for a budget without any limit, or with a
//           value in another unit than the chain's.
#pragma once

#include "stormcellar/accuracy/plan.h"

namespace stormcellar::accuracy {

// Returns the plan, which may not meet the budget; see Plan::meets_budget.
[[nodiscard]] Result<Plan> plan(const Chain& chain, const Budget& budget);

// Returns success if plan() can make a plan for this budget, else the error that plan() would
// return.
[[nodiscard]] Status validate(const Chain& chain, const Budget& budget);

// Returns the settings without which the candidate would leave less off or cost less, such as ";
// set off: refraction". Returns an empty text if there are none.
[[nodiscard]] std::string settings_in_the_way(const Chain& chain, const Budget& budget,
                                              const Candidate& candidate);

}  // namespace stormcellar::accuracy
