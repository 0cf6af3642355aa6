// stormcellar/accuracy/candidate.h -- every choice that the settings allow, with what it costs and
// leaves off.
//
// Thread contract: values and pure functions.
#pragma once

#include <vector>

#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/chain.h"

namespace stormcellar::accuracy {

struct Candidate {
    Choice choice;
    double cost_s = 0;    // predicted, of the whole chain
    double effort = 0;    // of the whole chain, in the chain's fixed scale
    ErrorSize left_off;   // SUM of the predictions of all effects that are off
    std::size_t off = 0;  // how many those are
};

// A chain with more choices than this is refused rather than searched for long.
inline constexpr std::size_t most_candidates = 65536;

// Of what the settings allow, in order of rising effort; of cost where the chain has no efforts:
// which is the cheapest is the same however busy the machine is. Left out are those that leave an
// effect of unbounded size off which may be on: no budget allows that, not even one that does not
// bound the quantity. Among equals the one with fewer effects left off comes first (accuracy that
// costs nothing is taken), then the one with the higher rung at the first step where they differ.
// Errors: as validate(); unsupported beyond most_candidates.
[[nodiscard]] Result<std::vector<Candidate>> list_candidates(const Chain& chain);

// Whether each sum is within its limit; what is not budgeted is not bounded.
[[nodiscard]] bool within(const ErrorSize& size, const Budget& budget);

// The largest share that a size takes of its limit: 0 for nothing, 1 when it is used up, infinite
// for anything against a limit of 0. A budget that bounds no error is replaced by 250 m, 0.5 of the
// moment's unit, dE 2, so that choices can be compared at all.
[[nodiscard]] double worst_share(const ErrorSize& size, const Budget& budget);

// Whether `a` is nearer to the budget than `b`: by worst_share(), and between equals (both without
// bound, or held by the same quantity) by the sum of the shares of 250 m, 0.5 of the unit and dE 2.
[[nodiscard]] bool is_more_accurate(const ErrorSize& a, const ErrorSize& b, const Budget& budget);

}  // namespace stormcellar::accuracy
