#include "grid/beam/detection_limit.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stormcellar/grid/sweep_choice.h"
#include "tests/grid/real_volume.h"

namespace stormcellar::grid {
namespace {

level2::Radial calibrated(float dbz0) {
    level2::Radial radial;
    radial.calibration_dbz = dbz0;
    radial.attenuation_db_per_km_thousandths = static_cast<std::int16_t>(-12);
    return radial;
}

TEST(DetectionLimit, IsTheRadarEquationAtTheThreshold) {
    level2::SweepMoment moment;
    moment.snr_threshold_db = 2;
    const DetectionLimit limit = detection_limit(calibrated(-43), moment, false);
    EXPECT_NEAR(limit.at(1000), -43 + 2 + 0.012, 1e-6);
    EXPECT_NEAR(limit.at(100e3), -43 + 2 + 40 + 1.2, 1e-6);
}

TEST(DetectionLimit, WithoutACalibrationAStatedCurveStandsIn) {
    level2::Radial radial;
    EXPECT_NEAR(detection_limit(radial, {}, false).at(50e3), -7.5, 0.03);  // the specification
    EXPECT_NEAR(detection_limit(radial, {}, true).at(10e3), -26, 1e-6);
}

TEST(DetectionLimit, DamagedFieldsAreNotBelieved) {
    const double plain = detection_limit({}, {}, false).at(1e5);
    level2::SweepMoment moment;
    moment.snr_threshold_db = std::numeric_limits<float>::quiet_NaN();
    level2::Radial radial;
    for (const float dbz0 : {std::nanf(""), 1e30F, -1e30F, 12.0F}) {
        radial.calibration_dbz = dbz0;
        EXPECT_EQ(detection_limit(radial, moment, false).at(1e5), plain);
    }
    radial.attenuation_db_per_km_thousandths = std::numeric_limits<std::int16_t>::min();
    EXPECT_EQ(detection_limit(radial, moment, false).at(1e5), plain);
}

TEST(DetectionLimit, IsFiniteAtRangeZero) {
    EXPECT_TRUE(std::isfinite(DetectionLimit{}.at(0)));
    EXPECT_TRUE(std::isfinite(DetectionLimit{}.at(-500)));
}

// Compares the limit with the weakest valid gate of each ring of 5 km. Leaves out rings with fewer
// than 100 valid gates, and rings within 20 km, where ground clutter and receiver limits dominate.
void expect_limit(const char* name, bool is_tdwr) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume(std::string("volumes/") + name);
    int rings = 0;
    for (const level2::Sweep& sweep : volume.sweeps) {
        const level2::SweepMoment* moment = sweep.find(level2::Moment::ref);
        if (moment == nullptr) continue;
        const DetectionLimit limit = detection_limit(sweep.radials.front(), *moment, is_tdwr);
        const std::int32_t ring = 5000 / moment->gate_spacing_m;
        for (std::int32_t from = 20000 / moment->gate_spacing_m; from < moment->gate_stride;
             from += ring) {
            double weakest = 1e9;
            int valid = 0;
            for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
                for (std::int32_t gate = from; gate < from + ring; ++gate) {
                    if (moment->status(radial, gate) != level2::GateStatus::valid) continue;
                    ++valid;
                    weakest =
                        std::min<double>(weakest, moment->value_of(moment->code(radial, gate)));
                }
            }
            if (valid < 100) continue;
            ++rings;
            // The weakest gate is never far below the limit; it is far above only where there is no
            // weak echo.
            EXPECT_GE(weakest, limit.at(moment->range_m(from)) - 3.5)
                << name << " cut " << sweep.elevation_number << " at " << moment->range_m(from);
        }
    }
    EXPECT_GT(rings, 0) << name;
}

TEST(DetectionLimit, RealVolumesShowNothingMuchWeaker) {
    expect_limit("KLOT20220317_000842_V06", false);
    expect_limit("KTLX19990503_235621.gz", false);
    expect_limit("KLIX20050828_180149.gz", false);
    expect_limit("Level2_KFTG_20150430_1419.ar2v", false);
}

}  // namespace
}  // namespace stormcellar::grid
