// stormcellar/accuracy/candidate.h -- lists all choices (stormcellar/accuracy/chain.h) that the
// user's settings allow, with the cost and the error of each.
//
// Units     Costs are in seconds. Efforts are in a fixed scale (Effect::effort).
// Threads   Candidates are plain values and all functions are pure.
// Errors    Only list_candidates() returns errors.
#pragma once

#include <vector>

#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/chain.h"

namespace stormcellar::accuracy {

struct Candidate {
    Choice choice;
    double cost_s = 0;    // predicted, for the whole chain
    double effort = 0;    // for the whole chain, in the fixed scale of Effect::effort
    ErrorSize left_off;   // left_off() of the choice
    std::size_t off = 0;  // the number of effects that are off, including Setting::not_asked
};

// The most choices that list_candidates() accepts; a search through more takes too long.
inline constexpr std::size_t most_candidates = 65536;

// Returns the choices that the settings allow, in order of rising effort. The choices of a chain
// without efforts are ordered by cost instead. Costs are measured, so the order then depends on how
// busy the machine was.
//
// A choice is not listed if it leaves off an effect of unbounded size that the settings allow to be
// on. No budget allows such a choice, not even a budget that does not bound the quantity. Choices
// of equal effort are ordered by the number of effects that are off, the fewest first, then by the
// rung at the first step where they differ, the higher rung first.
//
// Errors: the errors of validate(); unsupported for more than most_candidates choices.
[[nodiscard]] Result<std::vector<Candidate>> list_candidates(const Chain& chain);

// Returns true if each size is within the budget's limit, or the budget has no limit for it.
[[nodiscard]] bool within(const ErrorSize& size, const Budget& budget);

// Divides each error that the budget bounds by its limit, and returns the largest quotient: 0 if
// there is no error, 1 if a limit is just used up, infinity for any error against a limit of 0. If
// the budget bounds no error, the limits are 250 m, 0.5 of the moment's unit and dE 2, so that
// choices can still be compared.
[[nodiscard]] double worst_share(const ErrorSize& size, const Budget& budget);

// Returns true if `a` has the smaller worst_share(). If the shares are equal, returns true if `a`
// has the smaller sum of three quotients: each error divided by 250 m, 0.5 of the unit or dE 2.
[[nodiscard]] bool is_more_accurate(const ErrorSize& a, const ErrorSize& b, const Budget& budget);

}  // namespace stormcellar::accuracy
