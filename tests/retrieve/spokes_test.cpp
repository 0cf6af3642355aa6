#include "retrieve/quality/spokes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "tests/retrieve/echo_volume.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

std::vector<Spoke> spokes_of(const level2::Sweep& sweep,
                             const std::optional<SunPosition>& sun = std::nullopt) {
    return find_spokes(gate_field(sweep, *sweep.find(Moment::ref)), sweep, sun);
}

std::int64_t count(const std::vector<Spoke>& spokes, Spoke spoke) {
    return std::ranges::count(spokes, spoke);
}

// A sweep with a spoke of some radials from `first_m` to `last_m`, and 5 % speckles.
level2::Sweep sweep_with_spoke(double first_deg, double width_deg, double first_m, double last_m,
                               std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(10, 4);
    std::uniform_real_distribution<double> any(0, 1);
    EchoVolumeSpec spec;
    spec.elevations_deg = {0.5};
    return echo_volume(spec,
                       [&](const EchoPlace& place) -> EchoGate {
                           const double turn = std::fmod(place.azimuth_deg - first_deg + 360, 360);
                           const bool is_spoke = turn < width_deg && place.range_m >= first_m &&
                                                 place.range_m < last_m && any(random) < 0.95;
                           if (is_spoke || any(random) < 0.05) return {noise(random)};
                           return {};
                       })
        .sweeps.front();
}

TEST(Spokes, FindsInterferenceOfOneToThreeRadialsAlsoAcrossNorth) {
    for (const double width : {1, 2, 3})
        for (const double first : {40.0, 358.0, 359.0, 0.0}) {
            const auto found = spokes_of(sweep_with_spoke(first, width, 30e3, 150e3));
            const double gates = width * 240;
            EXPECT_GE(static_cast<double>(count(found, Spoke::interference)), 0.9 * gates)
                << width << " " << first;
            EXPECT_LE(static_cast<double>(count(found, Spoke::interference)), 1.05 * gates);
        }
}

TEST(Spokes, IgnoresShortRunsWideSectorsAndSpeckles) {
    EXPECT_TRUE(spokes_of(sweep_with_spoke(40, 1, 30e3, 80e3)).empty());
    EXPECT_TRUE(spokes_of(sweep_with_spoke(40, 6, 30e3, 150e3)).empty());
    EXPECT_TRUE(spokes_of(sweep_with_spoke(40, 0, 0, 0)).empty());
}

// Echo in the last radial of a sector scan is no spoke, because only one side of it was measured.
TEST(Spokes, IgnoresRadialsBesideAGap) {
    level2::Sweep sweep = sweep_with_spoke(40, 1, 30e3, 150e3);
    ASSERT_GT(count(spokes_of(sweep), Spoke::interference), 0);
    for (std::size_t radial = 41; radial < sweep.radials.size(); ++radial)
        sweep.radials[radial].azimuth_deg += 10;
    EXPECT_TRUE(spokes_of(sweep).empty());
}

TEST(Spokes, FindsTheSunInFrontOfAStormButOnlyWhereItIs) {
    std::mt19937 random(1);
    std::normal_distribution<float> noise(0, 1);
    EchoVolumeSpec spec;
    spec.elevations_deg = {14};
    // The storm reaches 40 km, and the sun shines through at -35 dBZ at 1 km.
    const level2::Sweep sweep =
        echo_volume(spec, [&](const EchoPlace& place) -> EchoGate {
            if (place.range_m < 40e3 && place.azimuth_deg > 270) return {35};
            if (std::abs(place.azimuth_deg - 279.75) > 1) return {};
            return {static_cast<float>(-35 + 20 * std::log10(place.range_m / 1000)) +
                    noise(random)};
        }).sweeps.front();
    const auto found = spokes_of(sweep, SunPosition{279.6, 14.2});
    const auto sun = static_cast<double>(count(found, Spoke::sun));
    EXPECT_GE(sun, 0.95 * 2 * 320);
    EXPECT_LE(sun, 1.05 * 3 * 320);
    for (const SunPosition& elsewhere : {SunPosition{279.6, 17}, {285, 14}, {99.6, 14}})
        EXPECT_EQ(count(spokes_of(sweep, elsewhere), Spoke::sun), 0);
}

struct SunCase {
    const char* file;
    const char* time;
    double latitude_deg, longitude_deg;
    std::size_t sweep;
    double azimuth_deg;
};

// Both sweeps have a spike of one or two radials to the end of the range, and nothing like it at
// other azimuths: KTLX at 14.0 degrees at 18:00 local time, behind a storm; KBBX at 15.6 degrees at
// 09:11 local time, below 5 dBZ.
TEST(Spokes, FindsTheSunInRealVolumes) {
    STORMCELLAR_NEED_DATA();
    for (const SunCase& one : {SunCase{"volumes/KTLX19990503_235621.gz", "1999-05-04T00:00:34Z",
                                       35.333, -97.278, 13, 279.2},
                               {"volumes/KBBX20060113_170337.gz", "2006-01-13T17:11:00Z", 39.496,
                                -121.632, 32, 135.8}}) {
        const auto decoded = level2::decode_file(testing::real_file(one.file));
        ASSERT_TRUE(decoded);
        const level2::Sweep& sweep = decoded->volume.sweeps.at(one.sweep);
        const auto sun =
            sun_position(*parse_utc(one.time, UtcTime{}), one.latitude_deg, one.longitude_deg);
        const auto found = spokes_of(sweep, sun);
        EXPECT_GT(count(found, Spoke::sun), 60) << one.file;
        const auto stride = static_cast<std::size_t>(sweep.find(Moment::ref)->gate_stride);
        for (std::size_t at = 0; at < found.size(); ++at) {
            if (found[at] != Spoke::sun) continue;
            EXPECT_NEAR(sweep.radials[at / stride].azimuth_deg, one.azimuth_deg, 1.2);
        }
    }
}

TEST(Spokes, HardCasesGiveNone) {
    level2::Sweep sweep = sweep_with_spoke(40, 1, 30e3, 150e3);
    sweep.radials[38].azimuth_deg = std::nanf("");
    EXPECT_TRUE(spokes_of(sweep, SunPosition{std::nan(""), 0}).empty());
    EchoVolumeSpec small;
    small.elevations_deg = {0.5};
    small.radials = 3;
    small.gates = 2;
    const auto all = [](const EchoPlace&) { return EchoGate{10}; };
    EXPECT_TRUE(spokes_of(echo_volume(small, all).sweeps.front(), SunPosition{}).empty());
    EXPECT_TRUE(find_spokes({}, {}, SunPosition{}).empty());
}

}  // namespace
}  // namespace stormcellar::retrieve
