// tests/retrieve/velocity_sweep.h -- makes sweeps of velocities with any azimuths and gates, whose
// codes are so fine that rounding does not matter.
#pragma once

#include <functional>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

struct SweepSpec {
    std::vector<float> azimuths_deg;
    double elevation_deg = 0.5;
    int gates = 400;
    int first_gate_m = 2000, gate_spacing_m = 250;
    float nyquist_mps = 200;
    UtcTime time;
};

inline constexpr double finest_mps = 0.002;  // between two codes

// Returns the velocity of a gate within +-65 m/s, NaN for no echo, or range_folded.
using SweepVelocity = std::function<double(double azimuth_deg, double range_m)>;
inline constexpr double range_folded = 1e6;

// Returns this many azimuths with equal steps; the first is half a step from north.
[[nodiscard]] std::vector<float> even_azimuths(int radials);

void add_sweep(level2::Volume& volume, const SweepSpec& spec, const SweepVelocity& velocity);
[[nodiscard]] level2::Volume volume_of(const SweepSpec& spec, const SweepVelocity& velocity);

// Returns fold numbers of 0.
[[nodiscard]] Dealiased no_folds(const level2::Volume& volume);

// Returns the angle from one azimuth to another in degrees, within +-180.
[[nodiscard]] double turn_deg(double from_deg, double to_deg);

}  // namespace stormcellar::retrieve
