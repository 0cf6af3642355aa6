// synth/vcp.h -- defines the volume coverage patterns that simulated radars run.
//
// Angles, rates, pulses, PRFs and thresholds of the built-in patterns are those of message 5 in
// real volumes: 212 (2015, precipitation, 17 cuts in 4.7 minutes), 215 (2020, 18 cuts in 6.1
// minutes) and 35 (2022, clear air, 12 cuts in 7.2 minutes). The lowest three angles are split
// cuts.
//
// Threads   Plain data and pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::synth {

enum class Waveform : std::uint8_t {  // with the numbers of message 5
    surveillance = 1,                 // REF only, to the longest range
    doppler = 2,                      // REF, VEL, SW: the second half of a split cut
    doppler_without_ambiguity = 3,    // REF, VEL, SW: high angles
    batch = 4,                        // REF, VEL, SW: middle angles
};

struct Cut {
    float elevation_deg = 0;  // a multiple of 180/32768, as message 5 holds it
    Waveform waveform = Waveform::surveillance;
    double azimuth_rate_deg_s = 0;  // a multiple of 22.5/16384
    float azimuth_spacing_deg = 1;  // 0.5 or 1
    int surveillance_prf = 0;       // numbers of the radar's PRFs, 1 to 8; 0: none
    int surveillance_pulses = 0;
    int doppler_prf = 0;
    int doppler_pulses = 0;
    float snr_threshold_db = 2;
    float nyquist_mps = 0;  // in hundredths; 0: that of the PRF
};

struct Pattern {
    int number = 0;
    std::vector<Cut> cuts;
};

// Return the nearest angle and rate that message 5 can express.
[[nodiscard]] float nearest_elevation_deg(double elevation_deg);
[[nodiscard]] double nearest_rate_deg_s(double rate_deg_s);

// Return the pattern of this number (null if it is not built in), and the built-in numbers, rising.
[[nodiscard]] const Pattern* find_pattern(int number);
[[nodiscard]] std::span<const int> pattern_numbers();

// Return the consequences of the PRFs of a cut. A Nyquist velocity that the cut itself has takes
// precedence over that of its PRF.
[[nodiscard]] float nyquist_mps(const Cut& cut);
[[nodiscard]] float unambiguous_range_m(const Cut& cut);
[[nodiscard]] bool has_velocity(const Cut& cut);

// The antenna moves for this long between two cuts. So the first radial of a cut follows the first
// radial of the previous cut after the time of the turn plus this time.
inline constexpr double move_s = 1.2;
[[nodiscard]] double duration_s(const Cut& cut);
[[nodiscard]] double duration_s(const Pattern& pattern);

// Returns the pattern as message 5.
[[nodiscard]] level2::Vcp to_message(const Pattern& pattern);

}  // namespace stormcellar::synth
