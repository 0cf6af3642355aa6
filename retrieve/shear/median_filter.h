// retrieve/shear/median_filter.h -- replaces each velocity by the median of 3 x 3 gates.
//
// Missing gates, and radials beyond a gap, do not count. An even number of velocities gives the
// mean of the two in the middle. A gate without a velocity stays without one.
//
// Accuracy  tests/retrieve/median_filter_test.cpp compares with sorted lists: the same bits.
// Threads   A pure function.
#pragma once

#include <vector>

#include "retrieve/shear/velocity_rows.h"

namespace stormcellar::retrieve {

// Returns the filtered velocities, rows x gates; NaN where there is no velocity.
[[nodiscard]] std::vector<float> median_filtered(const VelocityRows& rows);

}  // namespace stormcellar::retrieve
