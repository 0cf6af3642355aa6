// Tests find_cyclone() with Hurricane Harvey as Corpus Christi saw it, with Katrina out of reach of
// New Orleans, and with volumes that have no hurricane (../shared/data/volumes).
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/cyclone.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

level2::Volume decoded(const std::string& name) {
    auto decoded = level2::decode_file(*testing::data_directory() / "volumes" / name);
    if (!decoded) throw std::runtime_error(decoded.error().message);
    return std::move(decoded->volume);
}

// Returns the middle of the area of weak echo about a place, found by moving a circle of 20 km to
// the mean of the weak gates in it.
grid::PlanePoint middle_of_eye(const level2::Sweep& sweep, grid::PlanePoint start) {
    const level2::SweepMoment& moment = *sweep.find(level2::Moment::ref);
    for (int round = 0; round < 20; ++round) {
        double x_sum = 0, y_sum = 0, area = 0;
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
            const double azimuth = static_cast<double>(sweep.radials[radial].azimuth_deg) * degree;
            for (std::int32_t gate = 0; gate < moment.gate_counts[radial]; ++gate) {
                const double range = moment.range_m(gate);
                const double x = range * std::sin(azimuth), y = range * std::cos(azimuth);
                if (std::hypot(x - start.x_m, y - start.y_m) > 20e3) continue;
                const std::uint16_t code = moment.code(radial, gate);
                if (level2::status_of_code(moment.moment, code) == level2::GateStatus::valid &&
                    moment.value_of(code) > 25)
                    continue;
                x_sum += range * x;
                y_sum += range * y;
                area += range;
            }
        }
        start = {x_sum / area, y_sum / area};
    }
    return start;
}

// Every rung must give the same wind, although `profile` unfolds a part of the eyewall wrongly.
TEST(Harvey, HasTheSameWindForEachRung) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = decoded("KCRP20170826_044114.trimmed.ar2v");
    const grid::SiteFrame site(27.784, -97.511);
    // Search for the eye from the National Hurricane Center's position of 03 UTC, 28.0 N 97.0 W.
    // Carried on toward the north-west at 7 mph, that position is 14 km from the eye, in the
    // western eyewall.
    const grid::PlanePoint eye =
        middle_of_eye(volume.sweeps[0], grid::SiteFrame::to_plane(site.to_polar({28.0, -97.0})));
    for (const Dealiasing rung : {Dealiasing::profile, Dealiasing::region, Dealiasing::anchored}) {
        const auto found = find_cyclone(volume, dealias(volume, rung));
        ASSERT_TRUE(found) << found.error().text;
        const CycloneRing& top = found->maximum();
        EXPECT_NEAR(top.tangential_mps.value, 57, 2) << static_cast<int>(rung);
        EXPECT_NEAR(top.radius_m, 20e3, 3e3);
        EXPECT_LE(std::hypot(found->center_plane.x_m - eye.x_m, found->center_plane.y_m - eye.y_m),
                  5000)
            << static_cast<int>(rung);
        EXPECT_NEAR(found->height_m, 700, 150);
        // The Center gave 938 hPa; 55 km from the center the pressure is not yet that of the
        // surroundings.
        EXPECT_NEAR(found->pressure_deficit_hpa.value, 43, 5);
    }
}

TEST(Katrina, IsOutOfReachOfNewOrleans) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = decoded("KLIX20050828_180149.gz");
    const Dealiased folds = dealias(volume, Dealiasing::anchored);
    const auto searched = find_cyclone(volume, folds);
    ASSERT_FALSE(searched);
    EXPECT_EQ(searched.error().text,
              "no hurricane whose center is within 229 km, as far as velocities reach");
    CycloneOptions options;
    options.near = grid::GeoPoint{26.3, -88.6};  // the National Hurricane Center's, at 18 UTC
    const auto given = find_cyclone(volume, folds, options);
    ASSERT_FALSE(given);
    EXPECT_EQ(given.error().reason, NoCycloneReason::out_of_reach);
    EXPECT_EQ(given.error().text,
              "the center is 463 km from the radar, but velocities reach 229 km");
}

TEST(NoCyclone, InStormsThatAreNoHurricanes) {
    STORMCELLAR_NEED_DATA();
    for (const char* name : {"KLBB20160601_150025_V06", "KTLX19990503_235621.gz",
                             "KLOT20220317_000842_V06", "KOKX20080109_141449.gz",
                             "KDMX20220305_232324.trimmed.ar2v", "KCCX20130112_070503_V06.gz"}) {
        const level2::Volume volume = decoded(name);
        for (const Dealiasing rung : {Dealiasing::off, Dealiasing::profile, Dealiasing::anchored}) {
            const auto found = find_cyclone(volume, dealias(volume, rung));
            ASSERT_FALSE(found) << name;
            EXPECT_EQ(found.error().reason, NoCycloneReason::no_vortex) << found.error().text;
        }
    }
}

TEST(NoCyclone, WithoutTheNyquistVelocityOfATerminalRadar) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = decoded("Level2_TSTL_20220213_2357.ar2v");
    const auto found = find_cyclone(volume, dealias(volume, Dealiasing::anchored));
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().reason, NoCycloneReason::no_nyquist);
}

}  // namespace
}  // namespace stormcellar::retrieve
