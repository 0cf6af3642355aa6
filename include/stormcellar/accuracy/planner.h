// stormcellar/accuracy/planner.h -- finds the cheapest choice whose omitted effects stay within the
// budget.
//
// For every quantity that the budget bounds, the predicted sizes of all effects that are off must
// add up to at most the limit. An effect that the user set to off counts in the sum. Depending on
// what the budget bounds, the plan holds
//   for errors             the first of list_candidates() whose sums are within the budget
//   for errors and a time  the first of list_candidates() whose sums are within the budget and
//                          whose predicted cost is within the time
//   for a time alone       the most accurate choice within the time (is_more_accurate()), and the
//                          first of list_candidates() if several are equally accurate
// If no candidate fits, the plan holds the most accurate candidate within the time, or the first of
// list_candidates() if none is within the time. The search is exhaustive, for at most
// most_candidates choices, so it cannot miss the best choice.
//
// Units     As in stormcellar/accuracy/budget.h and chain.h.
// Threads   Pure functions.
// Errors    The errors of list_candidates(); bad_argument for a budget without any limit, or with a
//           value in another unit than the chain's.
#pragma once

#include "stormcellar/accuracy/plan.h"

namespace stormcellar::accuracy {

// Returns the plan, which may not meet the budget; see Plan::meets_budget.
[[nodiscard]] Result<Plan> plan(const Chain& chain, const Budget& budget);

// Checks the chain and the budget. Returns the error that plan() would return, except that only
// plan() refuses a chain with too many choices.
[[nodiscard]] Status validate(const Chain& chain, const Budget& budget);

// Returns the user's settings that keep the candidate from meeting the budget, or an empty text.
// The text is, for example, "; set off: refraction".
[[nodiscard]] std::string settings_in_the_way(const Chain& chain, const Budget& budget,
                                              const Candidate& candidate);

}  // namespace stormcellar::accuracy
