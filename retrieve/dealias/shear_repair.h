// retrieve/dealias/shear_repair.h -- unfolds gate by gate where neighbors still jump.
//
// A region can hold gates of two folds: in a tornado, inbound gates beyond the Nyquist velocity
// look like the outbound ones beside them. Then jumps are left along the region's edge. About each
// of them, every gate is a region of its own, and the gates around hold their fold numbers.
//
// Threads  Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {

// Changes the fold numbers of gates (radials x gates) near jumps of more than half a turn.
void repair_shear(const VelocitySheet& sheet, std::vector<std::int8_t>& folds);

}  // namespace stormcellar::retrieve
