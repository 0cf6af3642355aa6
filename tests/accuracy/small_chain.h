// tests/accuracy/small_chain.h -- chains for the planner's tests.
#pragma once

#include <random>

#include "stormcellar/accuracy/chain.h"
#include "stormcellar/accuracy/planner.h"

namespace stormcellar::accuracy::testing {

// Returns a chain of three steps, with values in decibels: a beam (4/3 earth, traced), a frame
// (sphere, ellipsoid, geodesic) and averaging (dB, linear Z). The four effects are refraction, the
// ellipsoid, the geodesic and linear Z. The error of leaving one of these effects off is 200 m, 240
// m, 30 m and 0.3 dB, in this order. The costs of the effects are 1 s, 0.1 s, 2 s and 0.5 s. The
// error of linear Z is known from a sample; the other errors are proven bounds.
[[nodiscard]] Chain small_chain();

// Returns a chain of up to four steps of up to three effects, with small whole numbers, so that
// ties and exact sums occur. Some effects are set on or off, but never in contradiction.
[[nodiscard]] Chain random_chain(std::mt19937_64& random);

// Returns the plan for `budget`. Throws if the budget is malformed or cannot be met.
[[nodiscard]] Plan plan_of(const Chain& chain, const char* budget);

}  // namespace stormcellar::accuracy::testing
