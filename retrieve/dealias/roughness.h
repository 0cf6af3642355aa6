// retrieve/dealias/roughness.h -- finds gates among velocities so rough that neighbors cannot show
// the fold number.
//
// Only differences along a radial count. Noise is as rough along a radial as across, but a tornado
// changes the velocity most from radial to radial.
//
// Accuracy  In three real volumes, folded again at 8.5 to 20 m/s, this marks 13 to 70 % of the
//           wrong gates, and 0.2 to 9 % of the right gates (bench/compare_dealiasing.py).
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {

// Returns 1 for each gate about which successive gates differ by more than an eighth of a turn in
// the mean. The mean is over nine pairs in each of five radials, so that a tornado alone is not
// rough, and a difference counts at most one turn. `folds` has the fold number of each gate of the
// sheet.
[[nodiscard]] std::vector<std::uint8_t> rough_gates(const VelocitySheet& sheet,
                                                    const std::vector<std::int8_t>& folds);

}  // namespace stormcellar::retrieve
