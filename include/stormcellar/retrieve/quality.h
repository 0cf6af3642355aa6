// stormcellar/retrieve/quality.h -- the probability that the echo of a gate is weather.
//
// Radars also see birds, insects, the ground, the sun and interference. The moment POW, probability
// of weather, has a number for each gate of a reflectivity moment. Values are not removed.
//
// Method    A sum of log-odds, one for each of a few features of the gate and its neighbors
//           (a generalized additive model). Its tables are taught by volumes whose correlation
//           coefficient tells weather (at least 0.95) from other echo (less than 0.8):
//           bench/teach_quality.cpp. There are two rules:
//             dual    correlation, textures of ZDR and PHI, reflectivity
//             single  features of reflectivity, velocity and spectrum width alone
//           Gates without dual polarization get the single rule. The reflectivity of a Doppler cut
//           takes the probability from the cut that has dual polarization at the same angle.
// Units     1 (0 to 1), in steps of 0.004. At 0.5 the rule keeps 99 % of the weather of at least
//           20 dBZ in the volumes that taught it.
// Accuracy  Of volumes that did not teach (bench/teach_quality.cpp prints the table).
// Not covered  Weak echo is mostly doubtful under the single rule: it keeps about half of the
//           weather below 20 dBZ. The rules were taught by super-resolution volumes of the central
//           United States and the Gulf coast.
// Source    Kind of features: Lakshmanan et al. (2014); Krause (2016). The tables are our own.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

enum class QualityRule : std::uint8_t { dual, single };

// The probability of weather at the gates of one reflectivity moment.
struct SweepQuality {
    std::size_t sweep = 0;             // index in the volume
    std::size_t moment = 0;            // index in the sweep
    std::vector<float> probabilities;  // radials x gate_stride; NaN where there is no echo
};

// Computes the probabilities of all reflectivity moments of a volume. `only_single` leaves the
// dual-polarization moments aside, as if the radar had none.
[[nodiscard]] std::vector<SweepQuality> weather_probabilities(const level2::Volume& volume,
                                                              bool only_single = false);

}  // namespace stormcellar::retrieve
