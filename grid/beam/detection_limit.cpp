#include "grid/beam/detection_limit.h"

#include <algorithm>
#include <cmath>

#include "base/floating_point.h"

namespace stormcellar::grid {
namespace {

constexpr double nearest_range_m = 100;
// A calibration beyond these limits comes from a damaged field.
constexpr float weakest_calibration_dbz = -80;
constexpr float strongest_calibration_dbz = 0;
constexpr int largest_attenuation_thousandths = 100;
constexpr float largest_snr_threshold_db = 20;

}  // namespace

double DetectionLimit::at(double range_m) const {
    const double range_km = std::max(range_m, nearest_range_m) / 1000;
    return at_1km_dbz + 20 * std::log10(range_km) + attenuation_db_per_km * range_km;
}

DetectionLimit detection_limit(const level2::Radial& radial, const level2::SweepMoment& moment,
                               bool is_tdwr) {
    DetectionLimit limit{.at_1km_dbz = is_tdwr ? tdwr_limit_at_1km_dbz : wsr88d_limit_at_1km_dbz};
    const bool calibrated =
        radial.calibration_dbz &&
        is_within(*radial.calibration_dbz, weakest_calibration_dbz, strongest_calibration_dbz);
    if (calibrated) {
        limit.at_1km_dbz = static_cast<double>(*radial.calibration_dbz);
        if (is_within(moment.snr_threshold_db, -largest_snr_threshold_db,
                      largest_snr_threshold_db)) {
            limit.at_1km_dbz += static_cast<double>(moment.snr_threshold_db);
        }
    }
    // The radar sends the attenuation as a negative number.
    const int thousandths = -radial.attenuation_db_per_km_thousandths.value_or(0);
    if (thousandths > 0 && thousandths <= largest_attenuation_thousandths) {
        limit.attenuation_db_per_km = thousandths / 1000.0;
    }
    return limit;
}

}  // namespace stormcellar::grid
