// tests/retrieve/phase_ramp.h -- volumes of one sweep whose differential phase is known.
//
// Units    Degrees, kilometers; gates of 250 m, the first at 2.125 km.
// Threads  Pure functions.
#pragma once

#include <functional>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

inline constexpr int ramp_radials = 45, ramp_gates = 400;

struct PhaseRamp {
    std::function<double(double range_km)> kdp;  // degrees/km
    double noise_deg = 2;                        // standard deviation
    double first_deg = 60;                       // phase at the first gate
    double backscatter_deg = 0;                  // a bump 0.6 km wide about 52 km
    bool has_gaps = false;                       // four gates of 40, and 7.5 km from 52 km on
    double speckle = 0;  // share of gates with another phase; four of five have a low correlation
};

// Returns the range of a gate's center.
[[nodiscard]] double ramp_range_km(int gate);
// Makes the volume. The noise is the same for the same ramp.
[[nodiscard]] level2::Volume volume_of_ramp(const PhaseRamp& ramp);

}  // namespace stormcellar::retrieve
