#include <fstream>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_in_process.h"
#include "tests/cli/uniform_grid.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

class Frame : public ::testing::Test {
  protected:
    void SetUp() override {
        auto store = cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
        ASSERT_TRUE(store) << store.error().message;
        for (const char* time : {"20050822_024400", "20050822_025000"}) {
            const grid::Grid grid = testing::uniform_grid(time, 33);
            testing::commit_grid(*store, grid);
            if (time == std::string("20050822_024400")) commit_velocity(*store, grid);
        }
    }

    // Commits velocities of 20 m/s in the lower half and -20 m/s above; the east is not seen.
    void commit_velocity(cache::StoreWriter& store, grid::Grid grid) {
        grid.moment = level2::Moment::vel;
        const auto levels = static_cast<std::size_t>(grid.spec.nz());
        for (std::size_t i = 0; i < grid.values.size(); ++i) {
            grid.values[i] = i % levels < levels / 2 ? 20.0F : -20.0F;
            const std::size_t ix = i / levels % static_cast<std::size_t>(grid.spec.nx);
            if (ix >= 30) grid.status[i] = grid::CellStatus::not_seen;
        }
        testing::commit_grid(store, grid);
    }

    int run(const std::string& arguments) {
        const auto ran =
            run_in_process("frame --cache " + (directory_ / "cache").string() + " " + arguments);
        messages_ = ran.err;
        facts_ = ran.out;
        return ran.status;
    }

    [[nodiscard]] std::string out(const char* name) const { return (directory_ / name).string(); }

    testing::TemporaryDirectory directory_;
    std::string messages_;
    std::string facts_;
};

TEST_F(Frame, DrawsTheLatestGridAsPng) {
    EXPECT_EQ(run("--domain KBGM -o " + out("a.png")), exit_done) << messages_;
    const std::string png = testing::file_text(out("a.png"));
    EXPECT_THAT(png, ::testing::StartsWith("\x89PNG"));
    EXPECT_THAT(png, ::testing::HasSubstr("2005-08-22T02:50:00Z"));
}

TEST_F(Frame, ARainTotalOfADomainIsOfTheGridsOfItsHours) {
    using ::testing::HasSubstr;
    const std::string rain = "--domain KBGM --product rain-total ";
    EXPECT_EQ(run(rain + "--hours 0.1 -o " + out("a.png")), exit_done) << messages_;
    EXPECT_THAT(testing::file_text(out("a.png")), HasSubstr("rain since 2005-08-22T02:44:00Z: 6 "));
    EXPECT_EQ(run(rain + "--hours 0.1 --probe-at KBGM --json"), exit_done) << messages_;
    const auto probe = nlohmann::json::parse(facts_)["probe"];
    EXPECT_EQ(probe["unit"], "mm");
    // 33 dBZ is 3.87 mm/h.
    EXPECT_NEAR(probe["value"].get<double>(), 0.387, 0.01);
    EXPECT_EQ(run(rain + "-o " + out("b.png")), exit_bad_usage);
    EXPECT_THAT(messages_, HasSubstr("a rain-total of a domain needs --hours"));
    EXPECT_EQ(run(rain + "--hours 25 -o " + out("b.png")), exit_bad_usage);
    EXPECT_THAT(messages_, HasSubstr("--hours must be above 0 and at most 24, not 25"));
    EXPECT_EQ(run("--domain KBGM --product composite --hours 1 -o " + out("b.png")),
              exit_bad_usage);
    EXPECT_THAT(messages_, HasSubstr("--hours is the length of a rain-total"));
    EXPECT_FALSE(fs::exists(out("b.png")));
}

TEST_F(Frame, TheEndingOfTheOutputIsItsFormat) {
    using ::testing::HasSubstr;
    using ::testing::StartsWith;
    const auto made = [&](const char* name, const std::string& more) {
        EXPECT_EQ(run("--domain KBGM -o " + out(name) + more), exit_done) << messages_;
        return testing::file_text(out(name));
    };
    for (const char* name : {"a.jpg", "a.webp"})
        EXPECT_THAT(made(name, " --slices 16"), HasSubstr("2005-08-22T02:50:00Z")) << name;
    EXPECT_THAT(testing::file_text(out("a.jpg")), StartsWith("\xFF\xD8\xFF"));
    EXPECT_THAT(testing::file_text(out("a.webp")), StartsWith("RIFF"));
    const std::string map = " --product composite";
    EXPECT_THAT(made("a.tif", map), HasSubstr("2005-08-22T02:50:00Z"));
    EXPECT_THAT(testing::file_text(out("a.tif")), StartsWith("II*"));
    EXPECT_THAT(made("a.kmz", map), HasSubstr("<when>2005-08-22T02:50:00Z</when>"));
    const std::string values = testing::file_text(out("a.tif"));
    EXPECT_NE(made("a.tif", map + " --geotiff states"), values);
    EXPECT_NE(made("a.tif", map + " --geotiff colors"), values);
    EXPECT_EQ(made("a.tif", map + " --geotiff values"), values);
}

TEST_F(Frame, WhatAFormatCannotHoldIsBadUsage) {
    EXPECT_EQ(run("--domain KBGM -o " + out("b.tif")), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("GeoTIFF holds maps; volume is none"));
    EXPECT_EQ(run("--domain KBGM -o " + out("b.png") + " --geotiff states"), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --product vil --geotiff grey -o " + out("b.tif")), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("values, states, colors"));
    EXPECT_EQ(run("--domain KBGM -o -.bmp"), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --json -o -.webp"), exit_bad_usage);
    for (const char* name : {"b.tif", "b.png", "-.bmp"})
        EXPECT_FALSE(fs::exists(out(name)));
}

TEST_F(Frame, TakesTheGridAtOrBeforeTheTime) {
    EXPECT_EQ(run("--domain KBGM --time 2005-08-22T02:49 --product composite -o " + out("a.png")),
              exit_done);
    EXPECT_THAT(testing::file_text(out("a.png")), ::testing::HasSubstr("2005-08-22T02:44:00Z"));
}

TEST_F(Frame, PanelsOfOneMomentAreNamedOnceAndHaveNoProbe) {
    EXPECT_EQ(run("--domain KBGM --panels REF --product composite --json -o " + out("a.png")),
              exit_done)
        << messages_;
    EXPECT_THAT(facts_, ::testing::HasSubstr("\"width\": 1280"));
    const std::string panels = "--domain KBGM -o " + out("b.png") + " --panels ";
    EXPECT_EQ(run(panels + "REF,REF"), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("names REF twice"));
    EXPECT_EQ(run(panels + "REF,XYZ"), exit_bad_usage);
    EXPECT_EQ(run(panels + "REF --moment REF"), exit_bad_usage);
    EXPECT_EQ(run(panels + "REF --probe 5,5"), exit_bad_usage);
    // 2026-11-26: the message about the first error advised a product that the program then
    // refused.
    EXPECT_EQ(run("--domain KBGM --panels REF -o " + out("b.tif")), exit_bad_usage);
    EXPECT_THAT(messages_,
                ::testing::HasSubstr("GeoTIFF, netCDF and KMZ hold a map of one moment; give "
                                     "--moment instead of --panels"));
    EXPECT_THAT(messages_, ::testing::Not(::testing::HasSubstr("--product composite")));
    EXPECT_EQ(run(panels + "REF,RHO"), exit_nothing_matched);
    EXPECT_THAT(messages_, ::testing::HasSubstr("there is no grid of RHO"));
    EXPECT_FALSE(fs::exists(out("b.png")));
    EXPECT_EQ(run(panels + "VEL,REF"), exit_done) << messages_;
    EXPECT_TRUE(fs::exists(out("b.png")));
}

TEST_F(Frame, ThemesDiffer) {
    EXPECT_EQ(run("--domain KBGM --product composite -o " + out("a.png")), exit_done);
    EXPECT_EQ(run("--domain KBGM --product composite --theme light -o " + out("b.png")), exit_done);
    EXPECT_NE(testing::file_text(out("a.png")), testing::file_text(out("b.png")));
    EXPECT_EQ(run("--domain KBGM --theme sepia -o " + out("c.png")), exit_bad_usage);
}

TEST_F(Frame, SaysWhatItDidAsJson) {
    EXPECT_EQ(run("--domain KBGM --json --width 500 --slices 16 -o " + out("a.png")), exit_done);
    EXPECT_THAT(facts_, ::testing::HasSubstr("\"width\": 500"));
    EXPECT_THAT(facts_, ::testing::HasSubstr("\"render_s\""));
    EXPECT_EQ(messages_, "");
}

TEST_F(Frame, NothingMatchedIsStatusThreeAndWritesNothing) {
    EXPECT_EQ(run("--domain KTLX -o " + out("a.png")), exit_nothing_matched);
    EXPECT_THAT(messages_, ::testing::HasSubstr("the domains are KBGM"));
    EXPECT_EQ(run("--domain KBGM --time 2005-08-22T02:43 -o " + out("a.png")),
              exit_nothing_matched);
    EXPECT_FALSE(fs::exists(out("a.png")));
}

TEST_F(Frame, NonsenseIsBadUsage) {
    EXPECT_EQ(run("--domain KBGM -o " + out("a.bmp")), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("JPEG (.jpg, .jpeg), WebP (.webp), GeoTIFF"));
    EXPECT_EQ(run("--domain KBGM --time noon -o " + out("a.png")), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --tilt 100 -o " + out("a.png")), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --width 100 -o " + out("a.png")), exit_bad_usage)
        << "the picture is too small for labels";
    EXPECT_EQ(run("--domain KBGM --width 100 --no-labels -o " + out("a.png")), exit_done);
    // 2026-11-29: the requested rung was ignored for grids that had been dealiased by another rung.
    EXPECT_EQ(run("--domain KBGM --moment VEL --dealias region -o " + out("a.png")),
              exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("--dealias region is for frames of files"));
}

TEST_F(Frame, FailuresNameTheFile) {
    EXPECT_EQ(run("--domain KBGM -o " + out("no/such/a.png")), exit_failed);
    EXPECT_THAT(messages_, ::testing::HasSubstr("no/such"));
}

TEST_F(Frame, DrawsEveryProduct) {
    for (const char* product :
         {"volume --slices 16", "composite", "cappi --height-km 4.2",
          "section --section 42.1,-76.1,42.3,-75.9", "echotop --echo-top-dbz 30", "vil",
          "lowest-seen", "highest-seen", "mesh --freezing-levels 3000,6000", "posh", "shi"}) {
        EXPECT_EQ(run(std::string("--domain KBGM -o ") + out("a.png") + " --product " + product),
                  exit_done)
            << product << " " << messages_;
    }
    EXPECT_EQ(run("--domain KBGM --product section -o " + out("b.png")), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("--section LAT,LON,LAT,LON"));
    EXPECT_EQ(run("--domain KBGM --product section --section 42,-76,43 -o " + out("b.png")),
              exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --product cappi --height-km 40 -o " + out("b.png")),
              exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("0.25 to 16.25 km"));
    EXPECT_FALSE(fs::exists(out("b.png")));
}

// 2026-11-22: a section outside the grid gave an empty picture.
TEST_F(Frame, ASectionOutsideTheGridIsRefused) {
    EXPECT_EQ(run("--domain KBGM --product section --section 35,-98,35.5,-97 -o " + out("b.png")),
              exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr(
                               "the section from 35.000\u00B0N 98.000\u00B0W to "
                               "35.500\u00B0N 97.000\u00B0W lies completely outside the grid"));
    // The grid reaches 20 km (0.180 and 0.243 degrees) to each side of 42.2 N 75.98 W.
    EXPECT_THAT(messages_, ::testing::HasSubstr("from 42.020\u00B0N 76.22"));
    EXPECT_THAT(messages_, ::testing::HasSubstr("to 42.380\u00B0N 75.73"));
    EXPECT_FALSE(fs::exists(out("b.png")));
    EXPECT_EQ(run("--domain KBGM --product section --section 42.2,-79,42.2,-76 -o " + out("b.png")),
              exit_done)
        << "part of the section is within the grid";
}

TEST_F(Frame, TakesTheNewestGridOfTheMoment) {
    EXPECT_EQ(run("--domain KBGM --moment VEL --product cappi -o " + out("a.png")), exit_done)
        << messages_;
    EXPECT_THAT(testing::file_text(out("a.png")), ::testing::HasSubstr("2005-08-22T02:44:00Z"));
    EXPECT_THAT(testing::file_text(out("a.png")), ::testing::HasSubstr("Radial velocity at 3 km"));
    EXPECT_EQ(run("--domain KBGM --moment RHO -o " + out("b.png")), exit_nothing_matched);
    EXPECT_THAT(messages_, ::testing::HasSubstr("there is no grid of RHO of domain 'KBGM'"));
    EXPECT_THAT(messages_, ::testing::HasSubstr("its grids are of REF, VEL"));
    EXPECT_EQ(run("--domain KBGM --moment RAIN -o " + out("b.png")), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --moment VEL --product vil -o " + out("b.png")), exit_bad_usage);
}

TEST_F(Frame, HailNamesTheHeightsThatItAssumes) {
    using ::testing::HasSubstr;
    ASSERT_EQ(run("--domain KBGM --product mesh --freezing-levels 1500,4800 -o " + out("a.tif")),
              exit_done)
        << messages_;
    const std::string map = testing::file_text(out("a.tif"));
    EXPECT_THAT(map, HasSubstr("0 C at 1500 m, -20 C at 4800 m above sea level, assumed"));
    EXPECT_THAT(map, HasSubstr("assuming 0 C at 1.5 km and -20 C at 4.8 km"));
    ASSERT_EQ(run("--domain KBGM --product posh -o " + out("b.png")), exit_done) << messages_;
    EXPECT_THAT(testing::file_text(out("b.png")),
                HasSubstr("0 C at 4200 m, -20 C at 7300 m above sea level, assumed"));
    for (const char* wrong : {"7300,4200", "4.2,7.3", "4200", "4200/7300", "nan,7300"})
        EXPECT_EQ(run(std::string("--domain KBGM --product mesh --freezing-levels ") + wrong +
                      " -o " + out("c.png")),
                  exit_bad_usage)
            << wrong;
    EXPECT_FALSE(fs::exists(out("c.png")));
}

TEST_F(Frame, TakesColorsByNameOrFile) {
    const std::string start =
        "--domain KBGM --product composite -o " + out("a.png") + " --colours ";
    EXPECT_EQ(run(start + "safe-reflectivity"), exit_done) << messages_;
    EXPECT_EQ(run(start + "rainbow"), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("the known tables are nws-reflectivity"));
    EXPECT_EQ(run(start + "nws-velocity"), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("in m/s, but the picture is in dBZ"));
    std::ofstream(out("mine.pal")) << "Product: BR\nColor: 5 0 0 0\nColor: 60 255 255 255\n";
    EXPECT_EQ(run(start + out("mine.pal")), exit_done) << messages_;
    std::ofstream(out("bad.pal")) << "Product: BR\nColor: 5 0 0\n";
    EXPECT_EQ(run(start + out("bad.pal")), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("bad.pal:2: "));
    EXPECT_EQ(run(start + out("none.toml")), exit_failed);
}

TEST_F(Frame, ProbesAPlaceOrAPixel) {
    EXPECT_EQ(run("--domain KBGM --product composite --probe-at 42.2,-75.98"), exit_done);
    EXPECT_THAT(facts_, ::testing::HasSubstr("value  33 dBZ at 0.5 km"));
    EXPECT_THAT(facts_, ::testing::HasSubstr("seen   0.5 to 16 km"));
    EXPECT_THAT(facts_, ::testing::HasSubstr("place  42.200\u00B0N 75.980\u00B0W"));
    const std::string in_feet = "--domain KBGM --product composite --units kft --probe-at ";
    EXPECT_EQ(run(in_feet + "42.2,-75.98"), exit_done);
    EXPECT_THAT(facts_, ::testing::HasSubstr("value  33 dBZ at 1.64 kft"));
    EXPECT_THAT(facts_, ::testing::HasSubstr("seen   1.64 to 52.49 kft"));
    EXPECT_EQ(run(in_feet + "42.2,-75.98 --json"), exit_done);
    EXPECT_EQ(nlohmann::json::parse(facts_)["probe"]["height_m"], 500) << "JSON stays in meters";
    EXPECT_EQ(run("--domain KBGM --product cappi --moment VEL --height-km 12 --probe 336,277 "
                  "--json -o " +
                  out("a.png")),
              exit_done)
        << messages_;
    EXPECT_TRUE(fs::exists(out("a.png")));
    const auto json = nlohmann::json::parse(facts_);
    EXPECT_EQ(json["moment"], "VEL");
    EXPECT_EQ(json["probe"]["status"], "value");
    EXPECT_EQ(json["probe"]["value"], -20);
    EXPECT_EQ(json["probe"]["unit"], "m/s");
    EXPECT_EQ(json["probe"]["height_m"], 12000);
    EXPECT_EQ(run("--domain KBGM --product cappi --moment VEL --probe-at 42.2,-75.79 --json"),
              exit_done);
    const auto unseen = nlohmann::json::parse(facts_);
    EXPECT_EQ(unseen["probe"]["status"], "not_seen");
    EXPECT_TRUE(unseen["probe"]["value"].is_null());
    EXPECT_TRUE(unseen["probe"]["lowest_seen_m"].is_null());
    EXPECT_FALSE(unseen.contains("output"));
}

TEST_F(Frame, NonsensicalProbesAreBadUsage) {
    EXPECT_EQ(run("--domain KBGM"), exit_bad_usage) << "there is neither a picture nor a probe";
    EXPECT_EQ(run("--domain KBGM --probe 1,2 --probe-at 1,2"), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --probe 1"), exit_bad_usage);
    EXPECT_EQ(run("--domain KBGM --probe 1.5,2"), exit_bad_usage);
    EXPECT_THAT(messages_, ::testing::HasSubstr("two whole numbers, not '1.5,2'"));
    for (const char* pixel : {"--probe 796,1", "--probe=-1,1", "--probe 1,9999", "--probe=1,-1"}) {
        EXPECT_EQ(run(std::string("--domain KBGM ") + pixel), exit_bad_usage) << pixel;
        EXPECT_THAT(messages_, ::testing::HasSubstr(
                                   "is outside the picture of 796 x 532 pixels: 0,0 to 795,531"))
            << pixel;
    }
    EXPECT_EQ(run("--domain KBGM --probe 1,2"), exit_bad_usage) << "the pixel is in the header";
    EXPECT_EQ(run("--domain KBGM --probe-at 10,10"), exit_bad_usage)
        << "the place is outside the grid";
}

}  // namespace
}  // namespace stormcellar::cli
