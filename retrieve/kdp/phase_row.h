// retrieve/kdp/phase_row.h -- the differential phase along one radial, unfolded and without
// speckle.
//
// Units     Degrees; gates.
// Threads   Plain data and pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace stormcellar::retrieve {

struct PhaseRow {
    std::vector<double> phases_deg;     // unfolded; 0 at gates that are not good
    std::vector<std::uint8_t> is_good;  // the phase shows the effect of the rain
    std::vector<std::uint8_t> has_phase;
};

// Unfolds the phases of a radial. A gate is good if its correlation coefficient is at least 0.85
// and if most gates within a box of 9 gates agree with its phase within 30 degrees. Phases and
// correlations are NaN where there is no value. Without correlations (an empty span) only the
// phases decide.
[[nodiscard]] PhaseRow unfold_phases(std::span<const float> phases_deg,
                                     std::span<const float> correlations);

// Returns the standard deviation of the noise about each gate, from second differences of the
// phases in `reach` gates on both sides. A ramp and a step of the slope do not change the result.
// The result is at least a tenth of a degree, which is the rounding of the radar's codes.
[[nodiscard]] std::vector<double> phase_noise_deg(const PhaseRow& row, int reach);

}  // namespace stormcellar::retrieve
