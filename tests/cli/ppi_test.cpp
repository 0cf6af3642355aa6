// Draws sweeps as the radar saw them, also as loops. The sweeps come from a whole file, from a
// truncated file, and from the catalog of a domain.
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/degree.h"
#include "stormcellar/base/file_system.h"
#include "tests/cli/files_and_service.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Ppi : public FilesAndService {
  protected:
    // Writes the first bytes of a volume, as if the radar were still sending it.
    [[nodiscard]] std::string cut_volume(const char* name, std::size_t bytes) const {
        std::ifstream whole(volume(name), std::ios::binary);
        std::string begin(bytes, '\0');
        whole.read(begin.data(), static_cast<std::streamsize>(bytes));
        std::ofstream(directory_ / name, std::ios::binary) << begin;
        return out(name);
    }

    // Returns the JSON of a frame with a probe at the place that `words` name.
    [[nodiscard]] nlohmann::json probe(Words words) const {
        words.insert(words.begin(), {"frame", "--product", "ppi", "--json"});
        return json_of(run(words));
    }
};

TEST_F(Ppi, SaysWhichSweepsThereAre) {
    const auto far = run({"frame", volume("KLBB20160601_150025_V06"), "--product", "ppi",
                          "--elevation", "45", "-o", out("a.png")});
    EXPECT_NE(far.status, 0);
    EXPECT_THAT(far.err, HasSubstr("0.5, 1.5, 2.4, 3.4, 4.3, 6.0, 9.9, 14.6, 19.5 degrees"));
    const auto none = run({"frame", volume("KLBB20160601_150025_V06"), "--product", "ppi",
                           "--moment", "VEL", "--sweep", "0", "-o", out("a.png")});
    EXPECT_NE(none.status, 0);
    EXPECT_THAT(none.err, HasSubstr("the sweeps with VEL are 1, 3, 4"));
    EXPECT_FALSE(fs::exists(out("a.png")));
}

// The program draws the sweeps and radials that a truncated file still holds.
TEST_F(Ppi, DrawsWhatIsThereOfAVolumeThatIsCut) {
    // The file has a third of the first sweep: the radials from the west to the northeast.
    const std::string begun = cut_volume("KLBB20160601_150025_V06", 400'000);
    const auto north = probe({begun, "--probe-at", "34.5,-101.8"});
    EXPECT_TRUE(north["partial"].get<bool>());
    EXPECT_NE(north["probe"]["status"], "not_seen");
    EXPECT_EQ(probe({begun, "--probe-at", "33.0,-101.8"})["probe"]["status"], "not_seen");
    const auto drawn = run({"frame", begun, "--product", "ppi", "-o", out("a.png")});
    EXPECT_EQ(drawn.status, 0) << drawn.err;

    // The file has two whole elevations. The frame shows the newest whole sweep of the lower
    // elevation.
    const std::string low = cut_volume("KLBB20160601_150025_V06", 1'500'000);
    const auto lowest = probe({low, "--probe-at", "34.0,-102.2"});
    EXPECT_TRUE(lowest["partial"].get<bool>());
    EXPECT_EQ(lowest["probe"],
              probe({volume("KLBB20160601_150025_V06"), "--probe-at", "34.0,-102.2"})["probe"]);
    const auto high =
        run({"frame", low, "--product", "ppi", "--elevation", "19.5", "-o", out("b.png")});
    EXPECT_NE(high.status, 0);
    EXPECT_THAT(high.err, HasSubstr("elevations of 0.5, 1.5 degrees"));
}

TEST_F(Ppi, BeamGlyphsStandOnVelocities) {
    const std::string file = volume("KLBB20160601_150025_V06");
    const auto draw = [&](const std::string& to, Words words) {
        words.insert(words.begin(), {"frame", file, "--product", "ppi", "-o", out(to)});
        return run(words);
    };
    ASSERT_EQ(draw("a.png", {"--moment", "VELD", "--glyphs"}).status, 0);
    ASSERT_EQ(draw("b.png", {"--moment", "VELD"}).status, 0);
    EXPECT_NE(testing::file_text(out("a.png")), testing::file_text(out("b.png")));
    const auto refused = draw("c.png", {"--glyphs"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr("beam glyphs show velocities, not REF"));
    // Only the panels of velocities have glyphs.
    const auto panels = draw("d.png", {"--panels", "REF,VEL", "--glyphs"});
    EXPECT_EQ(panels.status, 0) << panels.err;
}

TEST_F(Ppi, PanelsShowTheSweepOfEachMoment) {
    const std::string file = volume("KLBB20160601_150025_V06");
    const auto drawn = run({"frame", file, "--product", "ppi", "--panels", "REF,VEL,RHO,ZDR",
                            "--extent-km", "300,300", "-o", out("a.png")});
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_TRUE(fs::exists(out("a.png")));
    const auto planned =
        run({"frame", file, "--panels", "REF,VEL", "--tolerance", "dE 2", "-o", out("b.png")});
    EXPECT_EQ(planned.status, 2);
    EXPECT_THAT(planned.err, HasSubstr("not for --panels"));
}

TEST_F(Ppi, TheStormRelativeVelocityLosesTheMotionOfTheStorm) {
    const Words place = {volume("KTLX19990503_235621.gz"), "--moment", "SRV", "--probe-at",
                         "35.25,-97.60"};
    const auto at_rest = probe(with(place, {"--storm-motion", "0/0"})).at("probe");
    const auto from_west = probe(with(place, {"--storm-motion", "270/10"})).at("probe");
    // The place is west of the radar, and the storm comes from the west, toward the radar. Relative
    // to the storm, the air therefore seems to recede faster.
    const double azimuth = at_rest.at("gate").at("azimuth_deg");
    EXPECT_NEAR(azimuth, 252.9, 0.1);
    EXPECT_NEAR(from_west.at("value").get<double>() - at_rest.at("value").get<double>(),
                -10 * std::sin(azimuth * degree), 0.02);
}

TEST_F(Ppi, TheMotionIsSaidOrItsLackIs) {
    const auto refused = run({"frame", volume("KMPX20060106_184002.gz"), "--product", "ppi",
                              "--moment", "SRV", "-o", out("a.png")});
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("gives no storm motion: the highest wind is 0.3 km"));
    EXPECT_THAT(refused.err, HasSubstr("give the motion, as in --storm-motion 240/15"));
    EXPECT_FALSE(fs::exists(out("a.png")));
    const auto four = run({"frame", volume("KTLX19990503_235621.gz"), "--product", "ppi",
                           "--panels", "REF,SRV", "--storm-motion", "240/15", "-o", out("a.png")});
    EXPECT_EQ(four.status, 0) << four.err;
    const auto grid = run({"grid", volume("KTLX19990503_235621.gz"), "--moment", "SRV",
                           "--spacing-km", "4", "-o", out("a.nc")});
    EXPECT_EQ(grid.status, 0) << grid.err;
    EXPECT_THAT(grid.out, HasSubstr("note: storm motion 22"));
    EXPECT_THAT(grid.out, HasSubstr("right mover of the wind profile"));
}

TEST_F(Ppi, DealiasDrawsOtherVelocitiesInFrameAndLoop) {
    const std::string file = volume("KTLX19990503_235621.gz");
    const auto draw = [&](const char* name, const Words& more) {
        const auto drawn = run(with({"frame", file, "--product", "ppi", "-o", out(name)}, more));
        EXPECT_EQ(drawn.status, 0) << drawn.err;
        return *read_file(out(name));
    };
    const auto raw = draw("raw.png", {"--moment", "VEL"});
    const auto dealiased = draw("a.png", {"--moment", "VEL", "--dealias", "region"});
    EXPECT_NE(raw, dealiased);
    EXPECT_EQ(draw("b.png", {"--moment", "VELD", "--dealias", "region"}), dealiased);
    const auto refused = run({"frame", file, "--dealias", "region", "-o", out("no.png")});
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr("--dealias is for velocity; the moment is REF"));
    const auto contrary = run({"frame", file, "--product", "ppi", "--moment", "VELD", "--dealias",
                               "off", "-o", out("no.png")});
    EXPECT_EQ(contrary.status, 2);
    EXPECT_THAT(contrary.err,
                HasSubstr("--dealias off does not go with --moment VELD, which is dealiased"));
    const auto unknown =
        run({"loop", file, "--moment", "VEL", "--dealias", "strong", "-o", out("no.webp")});
    EXPECT_EQ(unknown.status, 2);
    EXPECT_THAT(unknown.err, HasSubstr("it must be off, auto, profile, region or anchored"));
    const auto json = json_of(
        run({"loop", file, "--product", "ppi", "--all-elevations", "--moment", "VEL", "--dealias",
             "region", "--cache", out("own"), "--json", "--quiet", "-o", out("up/")}));
    EXPECT_GT(json["frames"], 5);
}

TEST_F(Ppi, OfADomainIsThatOfItsRawFile) {
    const std::string file = volume("KTLX20170101_030027_V06");
    ingest(file);
    const Words what = {"--elevation", "1.5", "--moment", "VEL", "--probe-at", "35.5,-97.5"};
    const auto with = [&](Words words) {
        words.insert(words.end(), what.begin(), what.end());
        return probe(words);
    };
    // The cache has reflectivity alone; the raw file has all moments.
    const auto of_domain = with({"KTLX", "--config", out("config.toml")});
    const auto of_file = with({file});
    EXPECT_EQ(of_domain["probe"], of_file["probe"]);
    EXPECT_EQ(of_domain["time"], of_file["time"]);
    EXPECT_EQ(of_domain["domain"], "KTLX");
    EXPECT_EQ(with({"KTLX", "--cache", out("cache"), "--catalog", out("state/catalog")})["probe"],
              of_file["probe"]);
    // Options choose the plane of the sweep, as for a file.
    const auto placed = run({"frame", "KTLX", "--config", out("config.toml"), "--product", "ppi",
                             "--extent-km", "60,60", "-o", out("a.png")});
    EXPECT_EQ(placed.status, 0) << placed.err;

    fs::remove(directory_ / "drop/KTLX20170101_030027_V06");
    const auto gone = run(
        {"frame", "KTLX", "--config", out("config.toml"), "--product", "ppi", "-o", out("b.png")});
    EXPECT_NE(gone.status, 0);
    EXPECT_THAT(gone.err, HasSubstr("the raw file of KTLX 2017-01-01T03:00:27Z is gone"));
    EXPECT_EQ(run({"frame", "KTLX", "--config", out("config.toml"), "--product", "composite",
                   "--catalog", out("state/catalog"), "-o", out("b.png")})
                  .status,
              2);
}

// The loop has a frame for each elevation, from the lowest up; a split cut is one elevation.
TEST_F(Ppi, ALoopGoesThroughTheElevations) {
    const std::string file = volume("KTLX20170101_030027_V06");
    const auto json = json_of(run({"loop", file, "--product", "ppi", "--all-elevations", "--cache",
                                   out("own"), "--json", "--quiet", "-o", out("up/")}));
    EXPECT_EQ(json["frames"], 5) << "7 sweeps, of which two are split cuts";
    EXPECT_EQ(json["from"], "2017-01-01T03:00:27.187Z");
    EXPECT_EQ(json["domain"], "KTLX");
    EXPECT_TRUE(fs::exists(directory_ / "up/frame_0004.png"));
    EXPECT_FALSE(fs::exists(directory_ / "up/frame_0005.png"));

    // A scene file with the same setting and ping_pong gives eight frames.
    std::ofstream(directory_ / "up.toml")
        << "[picture]\nproduct = \"ppi\"\n[loop]\nall_elevations = true\nping_pong = true\n";
    EXPECT_EQ(json_of(run({"loop", "--scene", out("up.toml"), file, "--cache", out("own"), "--json",
                           "--quiet", "-o", out("b.webp")}))["frames"],
              8);
}

// This volume repeats its lowest two angles (MRLE), each as a split cut.
TEST_F(Ppi, ALoopShowsEachSweepThatTheRadarRepeated) {
    const std::string chunks = (data_ / "chunks/L2D_230").native();
    const auto loop = [&](Words words) {
        words.insert(words.begin(),
                     {"loop", chunks, "--product", "ppi", "--width", "400", "--height", "300",
                      "--cache", out("own"), "--json", "--quiet", "-o", out("frames/")});
        return json_of(run(words));
    };
    EXPECT_EQ(loop({})["frames"], 1);
    const auto repeats = loop({"--repeats"});
    EXPECT_EQ(repeats["frames"], 2);
    EXPECT_EQ(repeats["from"].get<std::string>().substr(0, 16), "2021-07-29T12:38");
    EXPECT_GT(repeats["to"], repeats["from"]);
    EXPECT_EQ(loop({"--repeats", "--moment", "VEL", "--elevation", "0.9"})["frames"], 2);
    EXPECT_EQ(loop({"--repeats", "--elevation", "1.3"})["frames"], 1);
    std::ofstream(directory_ / "low.toml") << "[loop]\nrepeats = true\n";
    EXPECT_EQ(loop({"--scene", out("low.toml")})["frames"], 2);
}

TEST_F(Ppi, ALoopGoesThroughTheVolumesOfFilesAndOfADomain) {
    const auto json =
        json_of(run({"loop", (data_ / "sequence-kbgm").native(), "--product", "ppi", "--cache",
                     out("own"), "--last", "2", "--json", "--quiet", "-o", out("a/")}));
    EXPECT_EQ(json["frames"], 2);
    EXPECT_THAT(json["from"].get<std::string>(), HasSubstr("2005-08-22T03:02:39"));

    ingest(volume("KTLX20170101_030027_V06"));
    EXPECT_EQ(
        json_of(run({"loop", "KTLX", "--config", out("config.toml"), "--product", "ppi", "--moment",
                     "RHO", "--all-elevations", "--json", "--quiet", "-o", out("b/")}))["frames"],
        5);
}

// 2026-11-30: HCA ignored --freezing-levels, and the picture did not name the assumed height.
TEST_F(Ppi, ClassesTakeTheHeightOfZeroDegreesWhereNoLayerIsSeen) {
    const auto noted = [&](const std::string& file, const Words& more) {
        const auto drawn = run(with({"frame", volume(file), "--product", "ppi", "--moment", "HCA",
                                     "--width", "400", "--height", "300", "-o", out("a.png")},
                                    more));
        EXPECT_EQ(drawn.status, 0) << drawn.err;
        return drawn.err;
    };
    const Words cold = {"--freezing-levels", "1500,4500"};
    const std::string no_layer = "KTLX20170101_030027_V06", layer = "KLBB20160601_150025_V06";
    EXPECT_THAT(noted(no_layer, {}), AllOf(HasSubstr("with 0 C at 4200 m above sea level"),
                                           HasSubstr("give --freezing-levels")));
    const auto usual = *read_file(out("a.png"));
    EXPECT_THAT(noted(no_layer, cold), AllOf(HasSubstr("with 0 C at 1500 m above sea level"),
                                             Not(HasSubstr("give --freezing-levels"))));
    EXPECT_NE(*read_file(out("a.png")), usual);
    EXPECT_THAT(noted(layer, {}), Not(HasSubstr("0 C")));
    const auto seen = *read_file(out("a.png"));
    noted(layer, cold);
    EXPECT_EQ(*read_file(out("a.png")), seen) << "the layer that the radar sees comes first";
}

TEST_F(Ppi, ALoopRefusesWhatMakesNoSense) {
    const std::string file = volume("KTLX20170101_030027_V06");
    const auto refused = [&](Words words) {
        words.insert(words.begin(), {"loop", file, "--cache", out("own"), "-o", out("a.webp")});
        const auto ran = run(words);
        EXPECT_EQ(ran.status, 2) << ran.err;
        return ran.err;
    };
    EXPECT_THAT(refused({"--product", "composite", "--all-elevations"}),
                HasSubstr("--all-elevations is for ppi"));
    EXPECT_THAT(refused({"--product", "ppi", "--all-elevations", "--elevation", "1"}),
                HasSubstr("leave out --elevation"));
    EXPECT_THAT(refused({"--product", "ppi", "--all-elevations", "--repeats"}),
                HasSubstr("--repeats shows the sweeps of one elevation"));
    EXPECT_THAT(refused({"--product", "ppi", "--interval", "60"}), HasSubstr("--interval"));
    EXPECT_THAT(refused({"--product", "ppi", "--frames", "50"}), HasSubstr("--frames"));
}

}  // namespace
}  // namespace stormcellar::cli
