// retrieve/dealias/shear_repair.h -- unfolds gate by gate where neighbors still jump.
//
// A region can hold gates of two folds: in a tornado, inbound gates beyond the Nyquist velocity
// look like the outbound gates beside them. In that case jumps remain along the edge of the region.
// The repair makes each gate near such a jump a region of its own; all other gates keep their fold
// numbers.
//
// Threads  Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {

// Changes the fold numbers `folds` (radials x gates) of gates near jumps of more than half a turn,
// except where so many pairs jump that the velocities are noise.
void repair_shear(const VelocitySheet& sheet, std::vector<std::int8_t>& folds);

}  // namespace stormcellar::retrieve
