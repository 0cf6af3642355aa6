#include "synth/synth_scene.h"

#include <cmath>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/site_frame.h"
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
    for (const char* name :
         {"instrument-all.toml", "moving-storm.toml", "small-storm.toml", "storm-line.toml",
          "truth-clear-air.toml", "truth-edge.toml", "truth-point.toml", "truth-sine.toml",
          "truth-stratiform.toml", "truth-supercell.toml"}) {
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
          {"station", "staton", "scene.toml:2: unknown key [radar] staton"},
          {"station", "site", "scene.toml:1: [radar] station: is missing"},
          {"[radar]", "[rader]", "scene.toml:1: unknown section [rader]"},
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

TEST(Scene, EveryKeyOfABoxAndAnInstrumentArrives) {
    const auto scene = parse_scene(std::string(least) + R"([[box]]
position_km = [1, 2]
radii_km = [3, 4]
base_km = 1
top_km = 5
peak_dbz = 35
edge_km = 0.25
wave_db = 6
wave_length_km = 7
wave_azimuth_deg = 8
[instrument]
seed = 9
beam_width_deg = 0.95
pulse_length_m = 470
noise_db = 1.5
velocity_noise_mps = 2
velocity_folding = "on"
range_folding = "on"
azimuth_jitter_deg = 0.1
elevation_jitter_deg = 0.2
missing_fraction = 0.01
missing_gate_fraction = 0.02
speckle_fraction = 0.03
missing_cuts = [2, 17]
[instrument.clutter]
peak_dbz = 40
range_km = 20
texture_db = 3
[[instrument.missing_radials]]
from_azimuth_deg = 350
to_azimuth_deg = 10
[[instrument.missing_radials]]
cut = 3
from_azimuth_deg = 20
to_azimuth_deg = 30
)",
                                   "scene.toml");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->weather.boxes.size(), 1U);
    const Box& box = scene->weather.boxes[0];
    EXPECT_EQ(box.footprint.minor_m, 4000);
    EXPECT_EQ(box.base_m, 1000);
    EXPECT_EQ(box.top_m, 5000);
    EXPECT_EQ(box.peak_dbz, 35);
    EXPECT_EQ(box.edge_m, 250);
    EXPECT_EQ(box.wave.most_db, 6);
    EXPECT_EQ(box.wave.length_m, 7000);
    EXPECT_EQ(box.wave.azimuth_deg, 8);
    const Instrument& instrument = scene->instrument;
    EXPECT_EQ(instrument.seed, 9U);
    EXPECT_EQ(instrument.beam_width_deg, 0.95);
    EXPECT_EQ(instrument.pulse_length_m, 470);
    EXPECT_EQ(instrument.noise_db, 1.5);
    EXPECT_EQ(instrument.velocity_noise_mps, 2);
    EXPECT_TRUE(instrument.velocity_folding);
    EXPECT_TRUE(instrument.range_folding);
    EXPECT_EQ(instrument.azimuth_jitter_deg, 0.1);
    EXPECT_EQ(instrument.elevation_jitter_deg, 0.2);
    EXPECT_EQ(instrument.missing_fraction, 0.01);
    EXPECT_EQ(instrument.missing_gate_fraction, 0.02);
    EXPECT_EQ(instrument.speckle_fraction, 0.03);
    EXPECT_EQ(instrument.missing_cuts, (std::vector<int>{2, 17}));
    ASSERT_TRUE(instrument.clutter);
    EXPECT_EQ(instrument.clutter->range_m, 20000);
    EXPECT_EQ(instrument.clutter->texture_db, 3);
    ASSERT_EQ(instrument.missing_radials.size(), 2U);
    EXPECT_FALSE(instrument.missing_radials[0].cut);
    EXPECT_EQ(instrument.missing_radials[1].cut, 3);
    EXPECT_EQ(instrument.missing_radials[1].to_deg, 30);
}

TEST(Scene, EveryKeyOfAWindArrives) {
    const auto scene = parse_scene(std::string(least) + R"([[wind.level]]
velocity_mps = [5, 20]
[[wind.level]]
height_km = 3
velocity_mps = [30, -10]
[[wind.vortex]]
position_km = [45, 10]
velocity_mps = [15, 5]
radius_km = 6
tangential_mps = -35
radial_mps = 4
decay = 0.5
base_km = 1
top_km = 9
[[wind.vortex]]
position_km = [1, 2]
radius_km = 3
radial_mps = 12
)",
                                   "scene.toml");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_TRUE(scene->weather.wind);
    const Wind& wind = *scene->weather.wind;
    ASSERT_EQ(wind.levels.size(), 2U);
    EXPECT_EQ(wind.levels[0].height_m, 0);
    EXPECT_EQ(wind.levels[0].wind.north_mps, 20);
    EXPECT_EQ(wind.levels[1].height_m, 3000);
    EXPECT_EQ(wind.levels[1].wind.east_mps, 30);
    ASSERT_EQ(wind.vortices.size(), 2U);
    const Vortex& vortex = wind.vortices[0];
    EXPECT_EQ(vortex.x_m, 45000);
    EXPECT_EQ(vortex.y_m, 10000);
    EXPECT_EQ(vortex.motion.east_mps, 15);
    EXPECT_EQ(vortex.motion.north_mps, 5);
    EXPECT_EQ(vortex.radius_m, 6000);
    EXPECT_EQ(vortex.tangential_mps, -35);
    EXPECT_EQ(vortex.radial_mps, 4);
    EXPECT_EQ(vortex.decay, 0.5);
    EXPECT_EQ(vortex.base_m, 1000);
    EXPECT_EQ(vortex.top_m, 9000);
    EXPECT_EQ(wind.vortices[1].tangential_mps, 0);
    EXPECT_EQ(wind.vortices[1].radial_mps, 12);
    EXPECT_EQ(wind.vortices[1].decay, 1);
    EXPECT_EQ(wind.vortices[1].base_m, -INFINITY);
    EXPECT_EQ(wind.vortices[1].top_m, INFINITY);
    EXPECT_FALSE(parse_scene(least, "scene.toml")->weather.wind);
}

TEST(Scene, AWindThatCannotBeIsRefused) {
    const std::string wind =
        "[[wind.level]]\nheight_km = 1\nvelocity_mps = [5, 20]\n"
        "[[wind.level]]\nheight_km = 2\nvelocity_mps = [5, 30]\n"
        "[[wind.vortex]]\nposition_km = [1, 2]\nradius_km = 3\ntangential_mps = 9\n"
        "base_km = 4\ntop_km = 5\n";
    ASSERT_EQ(message_of(least + wind), "");
    for (const Mistake& mistake :
         {Mistake{"height_km = 2", "height_km = 1",
                  "[wind.level] height_km: must be above the level before"},
          {"[5, 30]", "[5, 300]", "[wind.level] velocity_mps: 300 is out of range"},
          {"radius_km = 3", "radius_km = 0", "[wind.vortex] radius_km: 0 is out of range"},
          {"tangential_mps = 9", "decay = 1", "tangential_mps: is missing, and so is radial_mps"},
          {"base_km = 4", "base_km = 6", "[wind.vortex] top_km: must be above base_km"},
          {"[[wind.vortex]]", "[wind.vortex]", "must be sections"}}) {
        std::string toml = least + wind;
        toml.replace(toml.find(mistake.replace), std::string(mistake.replace).size(), mistake.by);
        EXPECT_THAT(message_of(toml), HasSubstr(mistake.message)) << mistake.by;
    }
    EXPECT_THAT(message_of(std::string(least) + "[wind]\n"),
                HasSubstr("[wind] level: is missing, and so is vortex"));
}

TEST(Scene, ACutHasAnyNyquistVelocity) {
    const std::string start = std::string(least) +
                              "[[cut]]\nelevation_deg = 0.5\nazimuth_rate_deg_s = 20\n"
                              "waveform = \"doppler\"\nnyquist_mps = 8.456\n";
    const auto scene = parse_scene(start, "scene.toml");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(nyquist_mps(scene->schedule.pattern.cuts[0]), 8.46F);
    std::string without = start;
    without.replace(without.find("doppler\""), 8, "surveillance\"");
    EXPECT_THAT(message_of(without), HasSubstr("[cut] nyquist_mps: is for cuts with velocity"));
    std::string high = start;
    high.replace(high.find("8.456"), 5, "63.01");
    EXPECT_THAT(message_of(high), HasSubstr("[cut] nyquist_mps: 63.01 is out of range"));
}

TEST(Scene, AnInstrumentDoesNothingUnlessItIsTold) {
    const auto scene = parse_scene(least, "scene.toml");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_FALSE(scene->instrument.changes_gates());
    EXPECT_EQ(scene->instrument.missing_fraction, 0);
    EXPECT_EQ(scene->instrument.azimuth_jitter_deg, 0);
    EXPECT_EQ(scene->instrument.elevation_jitter_deg, 0);
    const std::string start = std::string(least) + "[instrument]\n";
    EXPECT_THAT(message_of(start + "velocity_folding = \"yes\"\n"), HasSubstr("\"on\" or \"off\""));
    EXPECT_THAT(message_of(start + "missing_cuts = [18]\n"), HasSubstr("18 is not a cut"));
    EXPECT_THAT(message_of(start + "beam_width = 1\n"), HasSubstr("unknown key"));
}

// Both radars place a storm at the same point of the earth, within 50 m if the radars are 200 km
// away from the storm.
TEST(Scene, RadarsOfOneOriginSeeTheSameWeather) {
    const grid::SiteFrame origin(40, -97);
    for (const double longitude_deg : {-99.0, -97.0, -95.5}) {
        for (const double latitude_deg : {39.2, 40.0, 41.0}) {
            for (const auto& [x_km, y_km] : {std::pair{-60, 150}, {80, -140}, {10, 20}}) {
                const auto scene = parse_scene(
                    fmt::format(
                        "[radar]\nstation = \"XSYN\"\nlatitude_deg = {}\n"
                        "longitude_deg = {}\naltitude_m = 400\n[volumes]\ncount = 1\n"
                        "start = \"2024-06-01T22:00:00Z\"\nvcp = 212\n[weather]\n"
                        "latitude_deg = 40\nlongitude_deg = -97\n[[storm]]\n"
                        "position_km = [{}, {}]\nradii_km = [9, 9]\ncore_km = 3\ntop_km = 9\n"
                        "peak_dbz = 50\n",
                        latitude_deg, longitude_deg, x_km, y_km),
                    "scene.toml");
                ASSERT_TRUE(scene) << scene.error().message;
                const auto place =
                    origin.to_geo(grid::SiteFrame::from_plane(1000 * x_km, 1000 * y_km));
                const grid::SiteFrame radar(latitude_deg, longitude_deg);
                const auto seen = grid::SiteFrame::to_plane(radar.to_polar(place));
                const Footprint& footprint = scene->weather.storms.at(0).footprint;
                EXPECT_LT(std::hypot(footprint.x_m - seen.x_m, footprint.y_m - seen.y_m), 90)
                    << latitude_deg << ' ' << longitude_deg << ' ' << x_km << ' ' << y_km;
            }
        }
    }
    EXPECT_THAT(message_of(std::string(least) + "[weather]\nlatitude_deg = 3\n"),
                HasSubstr("[weather] longitude_deg: is missing"));
}

TEST(Scene, AMissingFileIsNamed) {
    const auto scene = read_scene("/nowhere/scene.toml");
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().code, ErrorCode::not_found);
    EXPECT_THAT(scene.error().message, HasSubstr("/nowhere/scene.toml"));
}

}  // namespace
}  // namespace stormcellar::synth
