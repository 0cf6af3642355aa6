// stormcellar/retrieve/dealias.h -- which velocities are folded, and how often.
//
// A Doppler radar measures velocity modulo twice the Nyquist velocity. The true velocity of a gate
// is raw + 2 n Nyquist, with a whole fold number n, which this finds. Values are never smoothed,
// replaced or invented.
//
// Rungs     profile   the fold number that brings a gate nearest to the wind at its height
//           region    regions without folds, joined so that neighbors agree as well as they can
//           anchored  the same, and with the wind at that height and the sweeps above and below
// Units     m/s; fold numbers.
// Source    Regions: Helmus and Collis (2016). The exact minimum over all regions: Bioucas-Dias and
//           Valadao (2007). Votes by the size of a jump, anchors and repair are our own.
// Accuracy  99.9 % of the gates of uniform, sheared and rotating winds with 1 m/s of noise, for
//           Nyquist velocities from 8 to 33 m/s (tests/retrieve/dealias_test.cpp). In noise the
//           minimum is not always reached, and `ambiguous` marks only some of the wrong gates.
// Errors    None. Gates without a value, and gates of radials without a Nyquist velocity (TDWR),
// have
//           the fold number 0.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

enum class Dealiasing : std::uint8_t { off, profile, region, anchored };

// Fold numbers of one moment of one sweep.
struct SweepFolds {
    std::size_t sweep = 0;   // index in the volume
    std::size_t moment = 0;  // index in the sweep
    // Rows as in the moment: radials x gate_stride.
    std::vector<std::int8_t> folds;
    // 1 where the fold number is a guess: little would change if it were another.
    std::vector<std::uint8_t> ambiguous;
};

struct Dealiased {
    std::vector<SweepFolds> sweeps;  // of all velocity moments, in the order of the volume
    // Pairs of adjacent gates, and those that jump by more than the Nyquist velocity as received.
    std::int64_t pairs = 0, jumps = 0;
    std::int64_t gates = 0, folded_gates = 0, ambiguous_gates = 0;
};

[[nodiscard]] Dealiased dealias(const level2::Volume& volume, Dealiasing rung);

}  // namespace stormcellar::retrieve
