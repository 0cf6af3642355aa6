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
//           A sweep without dual polarization, such as a Doppler cut, takes the probabilities of a
//           sweep of the same angle that has dual polarization. Without such a sweep, it gets the
//           single rule.
// Units     1 (0 to 1). At 0.5 a rule keeps 98.5 % of the weather of at least 20 dBZ in the volumes
//           that taught it. A larger number means that weather is more probable, but the numbers
//           are not frequencies (docs/quality.md).
// Accuracy  In five volumes that did not teach the rules, at 0.5 (bench/teach_quality.cpp): gates
//           with a correlation below 0.8 are removed (dual rule: 97.8 %, single rule: 96.5 %).
//           Gates of at least 20 dBZ with a correlation of at least 0.95 are kept (dual: 98.7 %,
//           single: 98.1 %). The hardest volume is in tests/retrieve/quality_test.cpp.
// Not covered  Of the weather below 20 dBZ, the single rule removes half and the dual rule a third.
//           The dual rule also removes a tenth of dense echo of low correlation, such as hail.
//           Seven radars in the middle of the United States and on its coasts taught the rules, all
//           in super-resolution.
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

// Computes the probabilities of all reflectivity moments of a volume. `only_single` ignores the
// dual-polarization moments, as if the radar had none.
[[nodiscard]] std::vector<SweepQuality> weather_probabilities(const level2::Volume& volume,
                                                              bool only_single = false);
// Computes the probabilities of one sweep alone, with the same results.
[[nodiscard]] std::vector<SweepQuality> weather_probabilities_of(const level2::Volume& volume,
                                                                 std::size_t sweep);

}  // namespace stormcellar::retrieve
