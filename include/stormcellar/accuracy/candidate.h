// stormcellar/accuracy/candidate.h -- all choices that the settings allow, with the cost and the
// error of each.
//
// Units     Costs are in seconds. Efforts are in the chain's own fixed scale.
// Threads   Candidates are plain values and all functions are pure.
// Errors    Only list_candidates() can fail.
#pragma once

#include <vector>

#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/chain.h"

namespace stormcellar::accuracy {

struct Candidate {
    Choice choice;
    double cost_s = 0;    // predicted, for the whole chain
    double effort = 0;    // for the whole chain, in the chain's fixed scale
    ErrorSize left_off;   // the SUM of the predictions of all effects that are off
    std::size_t off = 0;  // the number of those effects
};

// list_candidates() refuses a chain with more choices than this, because the search would take too
// long.
inline constexpr std::size_t most_candidates = 65536;

// Returns the choices that the settings allow, in order of rising effort. Effort rather than cost
// decides, so that the cheapest choice does not depend on how busy the machine is; a chain without
// efforts is ordered by cost.
//
// A choice is left out if it leaves off an effect of unbounded size that may be on. No budget
// allows that, not even a budget that does not bound the quantity. Among equals the choice with
// fewer effects left off comes first, because its accuracy costs nothing. After that, the choice
// with the higher rung at the first step where the two differ comes first.
//
// Errors: those of validate(); unsupported for more than most_candidates choices.
[[nodiscard]] Result<std::vector<Candidate>> list_candidates(const Chain& chain);

// Returns true if each sum is within its limit. A quantity without a budget has no limit.
[[nodiscard]] bool within(const ErrorSize& size, const Budget& budget);

// Returns the largest share of its limit that any of the three errors takes: 0 if there is no
// error, 1 if a limit is used up, infinity for any error against a limit of 0. For a budget that
// bounds no error the limits are 250 m, 0.5 of the moment's unit and dE 2, so that choices can
// still be compared.
[[nodiscard]] double worst_share(const ErrorSize& size, const Budget& budget);

// Returns true if `a` is nearer to the budget than `b` by worst_share(). If both are equal (both
// unbounded, or limited by the same quantity), the sum of the shares of 250 m, 0.5 of the unit and
// dE 2 decides.
[[nodiscard]] bool is_more_accurate(const ErrorSize& a, const ErrorSize& b, const Budget& budget);

}  // namespace stormcellar::accuracy
