// Runs `stormcellar profile` as a user does, and tests its output, files and exit status.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::ProgramResult;

constexpr const char* tornadoes = "KTLX19990503_235621.gz";

class ProfileTest : public ::testing::Test {
  protected:
    static ProgramResult profile(const Words& arguments) {
        return run(with({"profile"}, arguments));
    }
    [[nodiscard]] std::string at(const std::string& name) const { return directory_ / name; }

    testing::TemporaryDirectory directory_;
};

std::uint32_t number_at(const std::vector<std::byte>& png, std::size_t offset) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i)
        number = number << 8 | static_cast<std::uint32_t>(png.at(offset + i));
    return number;
}

TEST_F(ProfileTest, PrintsTheWindFromTheGroundUpAndTheMotionOfStorms) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran = profile({volume(tornadoes)});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("KTLX 1999-05-03T23:56:21Z (KTLX19990503_235621.gz)\n"));
    EXPECT_THAT(ran.out, HasSubstr("heights above sea level, antenna at 390 m"));
    EXPECT_THAT(ran.out,
                HasSubstr("\n      km   deg    m/s    m/s    m/s          deg\n    0.49 "));
    EXPECT_THAT(ran.out, HasSubstr("\n  right mover  22"));
    const ProgramResult american = profile({volume(tornadoes), "--units", "knots,kft"});
    EXPECT_THAT(american.out, HasSubstr("\n     kft   deg     kt     kt     kt          deg\n"));
    EXPECT_THAT(american.out, HasSubstr("from degrees/kt\n"));
}

// The soundings of Norman on that evening had winds from the south-south-east near the ground and
// from the south-west at 6 km, and the storms moved toward the north-east.
TEST_F(ProfileTest, JsonHasTheWindOfTheThirdOfMay) {
    STORMCELLAR_NEED_DATA();
    const auto json = json_of(profile({volume(tornadoes), "--json"})).at("profiles").at(0);
    EXPECT_EQ(json.at("station"), "KTLX");
    EXPECT_EQ(json.at("time"), "1999-05-03T23:56:21Z");
    const double antenna_m = json.at("antenna_altitude_m");
    int near_ground = 0, high = 0;
    for (const auto& layer : json.at("layers")) {
        if (!layer.contains("u_mps")) continue;
        const double above_m = layer.at("bottom_m").get<double>() - antenna_m;
        const double from = layer.at("direction_deg"), speed = layer.at("speed_mps");
        if (above_m < 500) {
            ++near_ground;
            EXPECT_NEAR(from, 165, 15);
        }
        if (above_m >= 5'800 && above_m <= 6'200) {
            ++high;
            EXPECT_NEAR(from, 223, 10);
            EXPECT_NEAR(speed, 26, 4);
        }
        EXPECT_LT(layer.at("u_error_mps"), 1);
        EXPECT_GT(layer.at("gates"), 100);
    }
    EXPECT_GE(near_ground, 2);
    EXPECT_GE(high, 2);
    const auto& right = json.at("storm_motion").at("right");
    EXPECT_NEAR(right.at("direction_deg"), 230, 15);
    EXPECT_NEAR(right.at("speed_mps"), 14, 4);
}

TEST_F(ProfileTest, DrawsAHodographOfOneVolume) {
    STORMCELLAR_NEED_DATA();
    const std::string plot = at("h.png");
    const ProgramResult ran =
        profile({volume(tornadoes), "--plot", plot, "--width", "500", "--height", "400"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(ran.out, HasSubstr(plot + ": written\n"));
    const auto png = *read_file(plot);
    EXPECT_EQ(number_at(png, 16), 500U);
    EXPECT_EQ(number_at(png, 20), 400U);
    EXPECT_EQ(profile({volume(tornadoes), "--plot", plot, "--width", "500", "--height", "400"}).out,
              ran.out);
    EXPECT_EQ(*read_file(plot), png) << "the plot has the same bytes again";
    const ProgramResult to_output = profile({volume(tornadoes), "--plot", "-"});
    EXPECT_EQ(to_output.out.substr(1, 3), "PNG");
}

TEST_F(ProfileTest, DrawsSeveralVolumesOfOneStationOnly) {
    STORMCELLAR_NEED_DATA();
    const std::string sequence = testing::real_file("sequence-kbgm");
    const auto json = json_of(profile({sequence, "--plot", at("w.png"), "--json"}));
    EXPECT_EQ(json.at("profiles").size(), 5U);
    EXPECT_EQ(json.at("written"), at("w.png"));
    EXPECT_TRUE(fs::exists(at("w.png")));
    const ProgramResult mixed = profile({sequence, volume(tornadoes), "--plot", at("m.png")});
    EXPECT_EQ(mixed.status, 2);
    EXPECT_THAT(mixed.err, HasSubstr("--plot draws one station, and the files are of KBGM, KTLX"));
    EXPECT_FALSE(fs::exists(at("m.png")));
    EXPECT_EQ(profile({sequence, volume(tornadoes)}).status, 0);
}

// A radar of the TDWR network does not send its Nyquist velocity.
TEST_F(ProfileTest, AVolumeWithoutWindSaysWhyAndEndsWith3) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult ran =
        profile({volume("Level2_TSTL_20220213_2357.ar2v"), "--plot", at("t.png")});
    EXPECT_EQ(ran.status, 3) << ran.err;
    EXPECT_THAT(ran.out, HasSubstr("  no Nyquist velocity\n"));
    EXPECT_THAT(ran.out, HasSubstr("\nno storm motion: no layer has a wind\n"));
    EXPECT_THAT(ran.err, HasSubstr("nothing is drawn"));
    EXPECT_FALSE(fs::exists(at("t.png")));
}

TEST_F(ProfileTest, BadUsageIsExit2AndBadFilesAreExit1) {
    std::ofstream(at("text")) << std::string(100'000, 'x');
    EXPECT_EQ(profile({}).status, 2);
    EXPECT_EQ(profile({at("text"), "--units", "miles per hour"}).status, 2);
    EXPECT_EQ(profile({at("text"), "--theme", "blue"}).status, 2);
    EXPECT_EQ(profile({at("text"), "--layer-m", "10"}).status, 2);
    EXPECT_EQ(profile({at("text"), "--reach-km", "4"}).status, 2);
    EXPECT_EQ(profile({at("text"), "--plot", at("p.svg")}).status, 2);
    EXPECT_EQ(profile({at("text"), "--plot", "-", "--json"}).status, 2);
    const ProgramResult text = profile({at("text")});
    EXPECT_EQ(text.status, 1);
    EXPECT_THAT(text.err, HasSubstr("not a Level II file"));
    EXPECT_EQ(text.out, "");
    EXPECT_EQ(profile({at("missing")}).status, 1);
}

}  // namespace
}  // namespace stormcellar::cli
