// retrieve/dealias/linked_regions.h -- finds regions that may hold gates of two fold numbers.
//
// Strong shear can bring velocities of two fold numbers into one third of the Nyquist interval. A
// few such gates link two large parts of the sheet to one region (regions.h). In that case the
// region has a long border along which velocities jump, whatever its fold number is.
//
// Accuracy Splitting such regions lowers the wrong gates of KCRP 2017, folded again at 12 m/s, from
//          6.1 to 0.6 %, and those of KTLX 1999 from 1.1 to 0.2 % (docs/velocity.md).
// Threads  Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/dealias/regions.h"
#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {

// Returns 1 for each region of n >= 512 gates at which at least max(20, sqrt(n) / 5) pairs of gates
// jump by more than half a turn. `folds` has the fold number of each gate of the sheet.
[[nodiscard]] std::vector<std::uint8_t> linked_regions(const VelocitySheet& sheet,
                                                       const SheetRegions& regions,
                                                       const std::vector<std::int8_t>& folds);

}  // namespace stormcellar::retrieve
