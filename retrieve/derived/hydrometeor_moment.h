// retrieve/derived/hydrometeor_moment.h -- the moment HCA, the class of hydrometeors.
//
// HCA has the gates and the flags of REF. A gate is ambiguous where no class fits.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// Adds HCA to the sweeps that have dual polarization. Returns a note that gives the melting layer.
// `zero_c_m` is as in hydrometeors().
[[nodiscard]] std::string add_hydrometeor_moment(level2::Volume& volume, double zero_c_m);

}  // namespace stormcellar::retrieve
