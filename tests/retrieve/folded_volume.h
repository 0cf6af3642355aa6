// tests/retrieve/folded_volume.h -- makes volumes whose true velocities are known, quickly: the air
// has echo everywhere, and no reflectivity is simulated.
//
// The antenna is at 35 degrees north and sea level. The noise of a gate depends on the seed, the
// sweep, the radial and the gate alone.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"
#include "synth/wind.h"

namespace stormcellar::retrieve {

struct FoldedSpec {
    double nyquist_mps = 12;
    std::vector<double> elevations_deg = {0.5, 1.5, 2.5, 3.5, 4.5};
    int radials = 360, gates = 400;
    double gate_spacing_m = 250;
    double noise_mps = 1;
    double missing = 0.05;  // share of gates
    double speckle = 0;     // share of gates with a random velocity, which score() leaves out
    std::uint32_t seed = 1;
};

// The velocity of a gate; NaN where there is no echo. Azimuth clockwise from north; height above
// the antenna.
using RadialVelocity = std::function<double(double azimuth_deg, double range_m,
                                            double elevation_deg, double height_m)>;

// Returns the component of a wind along the beam, at the start of its scene.
[[nodiscard]] RadialVelocity along_beam(const synth::Wind& wind);

struct FoldedVolume {
    level2::Volume volume;
    // The right fold numbers of each sweep, in rows like the velocities of the sweep.
    std::vector<std::vector<std::int8_t>> folds;
    // The true velocities without noise; NaN where the gate holds no velocity of the wind.
    std::vector<std::vector<double>> true_mps;
};

// Returns a velocity from -30 to 30 m/s that looks random, because gates side by side differ.
[[nodiscard]] double scattered_mps(double azimuth_deg, double range_m, double elevation_deg,
                                   double height_m);

// Return specs of odd volumes: one gate in each sweep, and one sweep of 367 radials, as legacy
// radars send them.
[[nodiscard]] FoldedSpec one_gate_spec();
[[nodiscard]] FoldedSpec one_legacy_sweep_spec();

[[nodiscard]] FoldedVolume fold(const FoldedSpec& spec, const RadialVelocity& velocity);
[[nodiscard]] FoldedVolume fold(const FoldedSpec& spec, const synth::Wind& wind);

struct Score {
    std::int64_t gates = 0, wrong = 0, wrong_unmarked = 0, marked = 0;
    double worst_sweep = 0;  // the largest share of wrong gates of a sweep
    [[nodiscard]] double wrong_share() const {
        return static_cast<double>(wrong) / static_cast<double>(gates);
    }
};
[[nodiscard]] Score score(const FoldedVolume& truth, const Dealiased& found);

}  // namespace stormcellar::retrieve
