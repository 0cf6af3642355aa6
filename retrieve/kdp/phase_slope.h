// retrieve/kdp/phase_slope.h -- the slope of the differential phase along one radial, by least
// squares in windows that adapt to it.
//
// Windows before, about and after a gate grow until the slope in a longer one contradicts the slope
// in a shorter one by more than their errors allow (intersection of confidence intervals:
// Goldenshluger and Nemirovski 1997, Katkovnik 1999). The slope is the mean of all windows that
// agree, and those about the gate weigh most. So the windows are long where the phase changes
// evenly, as in weak rain, and short beside the edges of a core.
//
// Units     Degrees and gates.
// Accuracy  include/stormcellar/retrieve/kdp.h.
// Threads   Pure functions.
#pragma once

#include <vector>

#include "retrieve/kdp/phase_row.h"

namespace stormcellar::retrieve {

struct PhaseSlopes {
    std::vector<float> deg_per_gate;  // NaN where no slope can be fitted
    std::vector<float> error;         // standard error of the slope; NaN likewise
};

// Takes backscatter phase out of the good gates: up to 3 km of gates that leave a line on which
// their neighbors on both sides stay.
void leave_out_backscatter(PhaseRow& row, double spacing_m);

// Fits slopes at the gates that have a phase.
[[nodiscard]] PhaseSlopes fit_slopes(const PhaseRow& row, double spacing_m);

}  // namespace stormcellar::retrieve
