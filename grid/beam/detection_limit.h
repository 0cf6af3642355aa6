// grid/beam/detection_limit.h -- computes the weakest reflectivity that a radar can show at a
// range.
//
// If a cell mixes gates with echo and gates without echo, a gate without echo counts as this value
// (docs/geometry.md):
//   limit_dbz = dbz0 + 20 log10(range / 1 km) + attenuation * range + snr_threshold
// Message 31 has dbz0, the attenuation and the threshold. (dbz0 is the calibration: the
// reflectivity at 1 km of an echo as strong as the noise.) If the message has no calibration, a
// fixed number replaces dbz0 + snr_threshold: -41.5 dBZ for a WSR-88D (-7.5 dBZ at 50 km, the
// specified sensitivity) and -46 dBZ for a TDWR (as the data show).
//
// Threads   Plain values and pure functions.
// Accuracy  The weakest echo of real volumes is within 3.5 dB of the limit (docs/geometry.md).
// Source    ICD 2620002 tables XVII-B, E, F and H.
#pragma once

#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

inline constexpr double wsr88d_limit_at_1km_dbz = -41.5;
inline constexpr double tdwr_limit_at_1km_dbz = -46;

struct DetectionLimit {
    double at_1km_dbz = wsr88d_limit_at_1km_dbz;  // without attenuation
    double attenuation_db_per_km = 0;             // over both ways, positive

    // Returns the limit in dBZ. Ranges below 100 m count as 100 m.
    [[nodiscard]] double at(double range_m) const;
};

// Returns the detection limit of one radial of a sweep.
[[nodiscard]] DetectionLimit detection_limit(const level2::Radial& radial,
                                             const level2::SweepMoment& moment, bool is_tdwr);

}  // namespace stormcellar::grid
