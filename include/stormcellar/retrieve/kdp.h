// stormcellar/retrieve/kdp.h -- the specific differential phase KDP: half the slope of the
// differential phase along the beam, with its standard error.
//
// Method    Gates count if their correlation coefficient is at least 0.85 and the phases of most
//           neighbors are within 30 degrees of their own. Their phases are unfolded outward. Phases
//           of backscatter are left out: up to 3 km of gates whose phases leave a line on which the
//           phases of the neighbors on both sides stay. KDP is the mean slope of windows of 1.75 to
//           20.25 km that hold the gate. A window counts if its slope agrees within 2.3 standard
//           errors with the slopes of the shorter windows, so that windows are long where KDP is
//           even, and short beside the edges of a core. The weight of a window is the inverse of
//           its error; at gates where most of the longest windows leave residuals of at most 1.5
//           times the noise, it is the inverse of the squared error. Reflectivity is not used, so
//           hail and errors of calibration do not matter.
// Units     Degrees per km; one way.
// Errors    None. NaN at gates without echo, and at gates where no window has five good gates and
//           60 % of its gates good. A gate whose own phase does not count may get a value from the
//           windows around it.
// Accuracy  On ramps of 45 radials with noise of 2 to 6 degrees (tests/retrieve/kdp_test.cpp): root
//           mean square error 0.035 degrees/km where KDP is constant, of either sign and without
//           bias, 0.15 in cores of 6 km, 0.3 at steps of 3 degrees/km. The true value is within the
//           stated error at 80 % of the gates of each ramp, and within twice the error at 93 %.
// Not covered  Backscatter phase in a core that also has KDP is not told from KDP. Beams that are
//           filled unevenly give false values of both signs. Ice and melting snow have KDP, too.
//           Noise that neighboring gates share looks like KDP, and its error is stated too low.
// Source    Windows that adapt: Goldenshluger and Nemirovski (1997), Katkovnik (1999). Limits on
//           correlation and backscatter phase follow the practice of Hubbert and Bringi (1995).
//           The settings and scores of Aldana et al. (2025, AMT 18, 793) were not reproduced.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// The values at the gates of one moment of differential phase.
struct SweepKdp {
    std::size_t sweep = 0;          // index in the volume
    std::size_t moment = 0;         // index in the sweep
    std::vector<float> deg_per_km;  // radials x gate_stride
    std::vector<float> error_deg_per_km;
};

// Computes KDP for all moments of differential phase of a volume; empty if it has none.
[[nodiscard]] std::vector<SweepKdp> specific_differential_phases(const level2::Volume& volume);

}  // namespace stormcellar::retrieve
