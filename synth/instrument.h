// synth/instrument.h -- what a simulated radar does to the truth; every effect is off by default.
//
// Plain data, read from the scene's [instrument] table (docs/scenes.md). The formulas stand with
// the code: synth/beam_quadrature.h (beam width, pulse) and synth/synth_effects.h (the rest).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stormcellar::synth {

// Ground clutter about the radar.
struct Clutter {
    double peak_dbz = 50;    // at the radar, in a beam on the horizon
    double range_m = 30000;  // 10 dBZ here
    double texture_db = 6;   // standard deviation from place to place
};

// Radials lost between two azimuths, clockwise, ends included.
struct MissingSector {
    std::optional<int> cut;  // from 1, in the pattern's order; none: every cut
    double from_deg = 0;
    double to_deg = 0;
};

struct Instrument {
    std::uint32_t seed = 0;         // of everything that is random
    double beam_width_deg = 0;      // half power, one way; 0: a line
    double pulse_length_m = 0;      // in space, c tau; 0: a point in range
    double noise_db = 0;            // deviation of a reflectivity far above the noise; 0: exact
    double velocity_noise_mps = 0;  // the same of a velocity
    bool velocity_folding = false;  // else velocities beyond the Nyquist velocity show as they are
    bool range_folding = false;     // else no echo comes from beyond the unambiguous range
    double azimuth_jitter_deg = 0;  // largest deviation from the nominal azimuth
    double elevation_jitter_deg = 0;
    double missing_fraction = 0;  // of the radials, at random
    std::vector<MissingSector> missing_radials;
    std::vector<int> missing_cuts;  // from 1
    std::optional<Clutter> clutter;

    // Whether a gate is the mean over a volume of air, not the sample of a point.
    [[nodiscard]] bool has_volume() const { return beam_width_deg > 0 || pulse_length_m > 0; }
    // Whether gates are anything but point samples.
    [[nodiscard]] bool changes_gates() const {
        return has_volume() || noise_db > 0 || velocity_noise_mps > 0 || velocity_folding ||
               range_folding || clutter.has_value();
    }
};

}  // namespace stormcellar::synth
