// synth/instrument.h -- lists the effects that turn the truth into the data of a simulated radar.
//
// Every effect is off by default.
//
// The values come from the scene's [instrument] table (docs/scenes.md). The formulas are in
// synth/beam_quadrature.h (beam width, pulse) and synth/synth_effects.h (the rest).
//
// Threads   Plain data.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stormcellar::synth {

// Ground clutter around the radar.
struct Clutter {
    double peak_dbz = 50;    // at the radar, for a beam on the horizon
    double range_m = 30000;  // clutter is 10 dBZ at this range
    double texture_db = 6;   // standard deviation from place to place
};

// Lost radials: those between two azimuths, clockwise, both included.
struct MissingSector {
    std::optional<int> cut;  // from 1, in the order of the pattern; none: all cuts
    double from_deg = 0;
    double to_deg = 0;
};

struct Instrument {
    std::uint32_t seed = 0;         // for all random numbers
    double beam_width_deg = 0;      // half power, one way; 0: a line
    double pulse_length_m = 0;      // in space, c tau; 0: a point in range
    double noise_db = 0;            // deviation of reflectivities far above the noise; 0: exact
    double velocity_noise_mps = 0;  // deviation of velocities far above the noise; 0: exact
    // if false, velocities beyond the Nyquist velocity stay as they are
    bool velocity_folding = false;
    // If false, echo beyond the unambiguous range does not fold back.
    bool range_folding = false;
    double azimuth_jitter_deg = 0;  // largest deviation from the nominal azimuth
    double elevation_jitter_deg = 0;
    double missing_fraction = 0;  // share of the radials, at random
    std::vector<MissingSector> missing_radials;
    std::vector<int> missing_cuts;     // from 1
    double missing_gate_fraction = 0;  // share of the gates, at random
    // Share of the gates without echo that have an isolated, weak echo of random velocity.
    double speckle_fraction = 0;
    std::optional<Clutter> clutter;

    // Returns true if a gate is a mean over a volume of air, not a sample at a point.
    [[nodiscard]] bool has_volume() const { return beam_width_deg > 0 || pulse_length_m > 0; }
    // Returns true if gates are more than point samples.
    [[nodiscard]] bool changes_gates() const {
        return has_volume() || noise_db > 0 || velocity_noise_mps > 0 || velocity_folding ||
               range_folding || clutter.has_value() || missing_gate_fraction > 0 ||
               speckle_fraction > 0;
    }
};

}  // namespace stormcellar::synth
