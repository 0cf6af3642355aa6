// retrieve/dealias/roughness.h -- finds gates among velocities so rough that neighbors cannot show
// the fold number.
//
// Accuracy  In three real volumes, folded again at 8.5 to 20 m/s, this mark has half to three
//           quarters of the wrong gates, and 1 to 5 % of the right ones
//           (bench/compare_dealiasing.py prints both shares).
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {

// Returns 1 for each gate about which neighboring gates differ by more than an eighth of a turn in
// the mean. The mean is over the pairs of adjacent gates among 5 x 5 gates, and a difference counts
// at most one turn. `folds` has the fold number of each gate of the sheet.
[[nodiscard]] std::vector<std::uint8_t> rough_gates(const VelocitySheet& sheet,
                                                    const std::vector<std::int8_t>& folds);

}  // namespace stormcellar::retrieve
