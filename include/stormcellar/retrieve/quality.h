// stormcellar/retrieve/quality.h -- the probability that the echo of a gate is weather.
//
// Radars also see birds, insects, the ground, the sun and interference. The moment POW, probability
// of weather, has a number for each gate of a reflectivity moment. Values are not removed.
//
// Method    A sum of log-odds, one for each of a few features of the gate and its neighbors
//           (a generalized additive model). Its tables are taught by volumes whose correlation
//           coefficient tells weather (at least 0.95, or 0.8 from 35 dBZ on) from other echo (less
//           than 0.8): bench/teach_quality.cpp. There are two rules:
//             dual    correlation, textures of ZDR and PHI, reflectivity
//             single  features of reflectivity, velocity and spectrum width alone
//           A sweep without dual polarization gets the single rule, unless a sweep of the same
//           angle has it, whose probabilities it takes then, as a Doppler cut does.
// Units     1 (0 to 1). At 0.5 a rule keeps 98.5 % of the weather of at least 20 dBZ in the volumes
//           that taught it. The numbers order gates; they are no frequencies (docs/quality.md).
// Accuracy  Of five volumes that did not teach, 0.5 removes 97.8 % (dual) and 96.5 % (single) of
//           the gates with a correlation below 0.8, and keeps 98.7 % and 98.1 % of those of at
//           least 20 dBZ with a correlation of at least 0.95 (bench/teach_quality.cpp). The hardest
//           of them is in tests/retrieve/quality_test.cpp.
// Not covered  The single rule removes half of the weather below 20 dBZ, the dual rule a third, and
//           a tenth of dense echo of low correlation, such as hail. Seven radars in the middle of
//           the United States and on its coasts taught the rules, all in super-resolution.
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
// Computes those of one sweep alone, with the same results.
[[nodiscard]] std::vector<SweepQuality> weather_probabilities_of(const level2::Volume& volume,
                                                                 std::size_t sweep);

}  // namespace stormcellar::retrieve
