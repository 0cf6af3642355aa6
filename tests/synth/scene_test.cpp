#include "synth/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/station_table.h"
#include "tests/testing/data.h"

namespace stormcellar::synth {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* least = R"([radar]
station = "KTLX"
[volumes]
count = 2
start = "2024-06-01T22:00:00Z"
vcp = 212
)";

std::string message_of(const std::string& toml) {
    const auto scene = parse_scene(toml, "scene.toml");
    if (scene) return "";
    EXPECT_EQ(scene.error().code, ErrorCode::bad_argument);
    return scene.error().message;
}

TEST(Scene, TheLeastHasTheStationsPlaceAndTheDefaults) {
    const auto scene = parse_scene(least, "scene.toml");
    ASSERT_TRUE(scene) << scene.error().message;
    const auto station = find_station("KTLX");
    EXPECT_EQ(scene->site.latitude_deg, station->latitude_deg);
    EXPECT_EQ(scene->site.longitude_deg, station->longitude_deg);
    EXPECT_NEAR(scene->site.antenna_altitude_m, station->antenna_altitude_m, 0.5);
    EXPECT_EQ(scene->schedule.count, 2);
    EXPECT_EQ(scene->schedule.interval_s, 300);
    EXPECT_EQ(format_utc(scene->schedule.start_of(1)), "2024-06-01T22:05:00Z");
    EXPECT_EQ(scene->schedule.pattern.number, 212);
    EXPECT_TRUE(scene->weather.storms.empty());
    EXPECT_TRUE(scene->weather.layers.empty());
}

TEST(Scene, EveryKeyArrivesInMetresAndSeconds) {
    const auto scene = parse_scene(R"([radar]
station = "XSYN"
latitude_deg = -10.5
longitude_deg = 20.25
altitude_m = 123.4
[volumes]
count = 3
start = "2024-06-01T22:00:00.5Z"
interval_s = 90.5
[[cut]]
elevation_deg = 0.5
waveform = "surveillance"
azimuth_rate_deg_s = 20
azimuth_spacing_deg = 0.5
[[cut]]
elevation_deg = 10
azimuth_rate_deg_s = 25
doppler_prf = 8
[[storm]]
position_km = [1, -2]
velocity_mps = [3, 4]
radii_km = [5, 6]
orientation_deg = 7
core_km = 8
top_km = 9
peak_dbz = 50
tilt = [0.1, 0.2]
ripple_db = 2
ripple_length_km = 3
[storm.hook]
center_km = [-1, -2]
radius_km = 3
arc_deg = [10, 200]
width_km = 4
top_km = 5
peak_dbz = 45
[[layer]]
position_km = [10, 20]
radii_km = [30, 40]
base_km = 1
top_km = 6
peak_dbz = 30
melting_km = 2
bright_band_db = 7
bright_band_depth_km = 0.2
lapse_db_per_km = 4
)",
                                   "scene.toml");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->site.antenna_altitude_m, 123);
    EXPECT_EQ(format_utc(scene->schedule.start_of(2)), "2024-06-01T22:03:01.500Z");
    ASSERT_EQ(scene->schedule.pattern.cuts.size(), 2U);
    EXPECT_EQ(scene->schedule.pattern.cuts[0].waveform, Waveform::surveillance);
    EXPECT_EQ(scene->schedule.pattern.cuts[0].azimuth_spacing_deg, 0.5F);
    EXPECT_EQ(scene->schedule.pattern.cuts[1].waveform, Waveform::batch);
    EXPECT_EQ(scene->schedule.pattern.cuts[1].doppler_prf, 8);
    EXPECT_NEAR(scene->schedule.pattern.cuts[1].elevation_deg, 10, 180.0 / 65536);
    ASSERT_EQ(scene->weather.storms.size(), 1U);
    const Storm& storm = scene->weather.storms[0];
    EXPECT_EQ(storm.footprint.x_m, 1000);
    EXPECT_EQ(storm.footprint.y_m, -2000);
    EXPECT_EQ(storm.footprint.motion.north_mps, 4);
    EXPECT_EQ(storm.footprint.minor_m, 6000);
    EXPECT_EQ(storm.footprint.orientation_deg, 7);
    EXPECT_EQ(storm.core_m, 8000);
    EXPECT_EQ(storm.top_m, 9000);
    EXPECT_EQ(storm.tilt_north, 0.2);
    EXPECT_EQ(storm.ripple.length_m, 3000);
    ASSERT_TRUE(storm.hook);
    EXPECT_EQ(storm.hook->y_m, -2000);
    EXPECT_EQ(storm.hook->to_deg, 200);
    EXPECT_EQ(storm.hook->width_m, 4000);
    ASSERT_EQ(scene->weather.layers.size(), 1U);
    const Layer& layer = scene->weather.layers[0];
    EXPECT_EQ(layer.base_m, 1000);
    EXPECT_EQ(layer.bright_band_depth_m, 200);
    EXPECT_DOUBLE_EQ(layer.lapse_db_per_m, 0.004);
}

TEST(Scene, ThoseOfTheProjectAreRead) {
    for (const char* name : {"moving-storm.toml", "small-storm.toml"}) {
        const auto scene = read_scene(testing::source_directory() / "scenes" / name);
        EXPECT_TRUE(scene) << scene.error().message;
    }
}

struct Mistake {
    const char* replace;
    const char* by;
    const char* message;
};

TEST(Scene, AMistakeIsNamedWithItsLineAndKey) {
    for (const Mistake& mistake :
         {Mistake{"\"KTLX\"", "\"OKLAHOMA\"", "scene.toml:2: [radar] station: must be four"},
          {"\"KTLX\"", "\"XSYN\"", "scene.toml:1: [radar] latitude_deg: is missing"},
          {"\"KTLX\"", "12", "scene.toml:2: [radar] station: must be text"},
          {"station", "staton", "scene.toml:1: [radar] station: is missing"},
          {"[radar]", "[rader]", "scene.toml: [radar] station: is missing"},
          {"count = 2", "count = 0", "scene.toml:4: [volumes] count: 0 is out of range, must be 1"},
          {"count = 2", "count = 2.5", "[volumes] count: must be a whole number"},
          {"count = 2", "count = nan", "[volumes] count: must be a whole number"},
          {"\"2024-06-01T22:00:00Z\"", "\"now\"", "scene.toml:5: [volumes] start: must be a time"},
          {"\"2024-06-01T22:00:00Z\"", "\"2024-13-01\"", "[volumes] start: must be a time"},
          {"vcp = 212", "vcp = 11", "scene.toml:6: [volumes] vcp: 11 is not one of 35, 212, 215"},
          {"vcp = 212", "vcp = 212\ninterval_s = 30",
           "scene.toml:7: [volumes] interval_s: 30 s is shorter than"},
          {"vcp = 212", "vcp = 212\nwind = 3", "scene.toml:7: unknown key [volumes] wind"},
          {"vcp = 212", "vcp = 212\n[[storm]]\n", "scene.toml:7: [storm] position_km: is missing"},
          {"vcp = 212", "vcp = 212\n[storm]\n", "scene.toml:7: storm: must be sections: [[storm]]"},
          {"vcp = 212", "vcp = ", "scene.toml:6: not valid TOML"}}) {
        std::string toml = least;
        toml.replace(toml.find(mistake.replace), std::string(mistake.replace).size(), mistake.by);
        EXPECT_THAT(message_of(toml), StartsWith("scene.toml")) << mistake.by;
        EXPECT_THAT(message_of(toml), HasSubstr(mistake.message)) << mistake.by;
    }
}

TEST(Scene, AStormThatCannotBeIsRefused) {
    const std::string storm =
        "[[storm]]\nposition_km = [1, 2]\nradii_km = [5, 6]\ncore_km = 8\ntop_km = 9\n"
        "peak_dbz = 50\n";
    ASSERT_EQ(message_of(least + storm), "");
    for (const Mistake& mistake :
         {Mistake{"[1, 2]", "[1]", "[storm] position_km: must be two numbers"},
          {"[1, 2]", "[1, \"far\"]",
           "[storm] position_km: must be an array of numbers, holds text"},
          {"[5, 6]", "[5, 0]", "[storm] radii_km: 0 is out of range"},
          {"top_km = 9", "top_km = 8", "[storm] top_km: must be above core_km"},
          {"peak_dbz = 50", "peak_dbz = 9", "[storm] peak_dbz: 9 is out of range"},
          {"peak_dbz = 50", "peak_dbz = inf", "[storm] peak_dbz: inf is out of range"},
          {"peak_dbz = 50", "peak_dbz = 50\nhook = 1",
           "[storm] hook: must be a section: [storm.hook]"}}) {
        std::string toml = least + storm;
        toml.replace(toml.find(mistake.replace), std::string(mistake.replace).size(), mistake.by);
        EXPECT_THAT(message_of(toml), HasSubstr(mistake.message)) << mistake.by;
    }
}

TEST(Scene, AMissingFileIsNamed) {
    const auto scene = read_scene("/nowhere/scene.toml");
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().code, ErrorCode::not_found);
    EXPECT_THAT(scene.error().message, HasSubstr("/nowhere/scene.toml"));
}

}  // namespace
}  // namespace stormcellar::synth
