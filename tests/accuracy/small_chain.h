// tests/accuracy/small_chain.h -- chains for the planner's tests.
#pragma once

#include <random>

#include "stormcellar/accuracy/chain.h"
#include "stormcellar/accuracy/planner.h"

namespace stormcellar::accuracy::testing {

// A beam (4/3 earth, traced) and a frame (sphere, ellipsoid, geodesic), in decibels:
//   refraction 200 m, costs 1 s; ellipsoid 240 m, costs 0.1 s; geodesic 30 m, costs 2 s
//   and averaging (dB, linear Z), 0.3 dB, costs 0.5 s, known by sample; the others are proven.
[[nodiscard]] Chain small_chain();

// Up to four steps of up to three effects, small whole numbers so that ties and exact sums happen,
// some of them set on or off, never against each other.
[[nodiscard]] Chain random_chain(std::mt19937_64& random);

// The plan of what `budget` says, which must be well said and possible: throws otherwise.
[[nodiscard]] Plan plan_of(const Chain& chain, const char* budget);

}  // namespace stormcellar::accuracy::testing
