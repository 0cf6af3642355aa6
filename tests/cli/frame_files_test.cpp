// Tests pictures of files without a daemon, and where commands find the service's directories.
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/cli/files_and_service.h"
#include "tests/testing/file_bytes.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

class FrameFiles : public FilesAndService {
  protected:
    // Returns the compressed pixels of a PNG, without its texts.
    [[nodiscard]] std::string pixels_of(const std::string& path) const {
        const std::string png = testing::file_text(path);
        std::string pixels;
        for (std::size_t at = 8; at + 12 <= png.size();) {
            std::size_t length = 0;
            for (std::size_t i = 0; i < 4; ++i)
                length = length * 256 + static_cast<unsigned char>(png[at + i]);
            if (png.compare(at + 4, 4, "IDAT") == 0) pixels += png.substr(at + 8, length);
            at += 12 + length;
        }
        return pixels;
    }
};

// The pictures of the file and of the daemon's grid have the same pixels and texts.
TEST_F(FrameFiles, IsThePictureOfTheStoredGrid) {
    const std::string file = volume("KTLX19990503_235621.gz");
    ingest(file);
    for (const std::string product : {"volume", "composite"}) {
        const auto from_file =
            run({"frame", file, "--product", product, "-o", out("file.png"), "--threads", "2"});
        ASSERT_EQ(from_file.status, 0) << from_file.err;
        const auto from_cache = run({"frame", "KTLX", "--config", out("config.toml"), "--product",
                                     product, "-o", out("cache.png")});
        ASSERT_EQ(from_cache.status, 0) << from_cache.err;
        EXPECT_FALSE(pixels_of(out("file.png")).empty());
        EXPECT_TRUE(pixels_of(out("file.png")) == pixels_of(out("cache.png"))) << product;
    }
}

TEST_F(FrameFiles, RotationIsDrawnOverAVolume) {
    const std::string file = volume("KTLX19990503_235621.gz");
    const auto draw = [&](const std::string& to, Words words) {
        words.insert(words.begin(), {"frame", file, "-o", out(to)});
        return run(words);
    };
    const auto with = draw("a.png", {"--rotation"});
    ASSERT_EQ(with.status, 0) << with.err;
    ASSERT_EQ(draw("b.png", {}).status, 0);
    EXPECT_FALSE(pixels_of(out("a.png")) == pixels_of(out("b.png")));
    for (const Words& words :
         {Words{"--rotation", "--product", "ppi"}, Words{"--rotation", "--moment", "AZSH"},
          Words{"--rotation", "--panels", "REF,VEL"}})
        EXPECT_EQ(draw("c.png", words).status, 2) << words.back();
    EXPECT_FALSE(fs::exists(out("c.png")));
}

TEST_F(FrameFiles, RotationOfADomainNeedsItsShear) {
    ingest(volume("KTLX19990503_235621.gz"));
    const auto refused =
        run({"frame", "KTLX", "--cache", out("cache"), "--rotation", "-o", out("a.png")});
    EXPECT_NE(refused.status, 0);
    EXPECT_THAT(refused.err, HasSubstr("domain 'KTLX' has no grid of AZSH at 1999-05-03T23:56:21"));
}

TEST_F(FrameFiles, SeveralSitesAreAMosaic) {
    const fs::path northeast = data_ / "mosaic-northeast";
    const auto json =
        json_of(run({"frame", (northeast / "KBGM20100911_012056_V03.gz").native(),
                     (northeast / "KENX20100911_011108_V03.gz").native(), "--product", "composite",
                     "--spacing-km", "4", "--levels-km", "1:9:2", "--json", "-o", out("a.png")}));
    EXPECT_EQ(json["domain"], "KBGM+KENX");
    EXPECT_THAT(testing::file_text(out("a.png")), HasSubstr("KBGM KENX"));
}

TEST_F(FrameFiles, TheGridIsWhereItWasAskedFor) {
    const auto json =
        json_of(run({"frame", volume("KTLX19990503_235621.gz"), "--center", "35.3,-97.6",
                     "--extent-km", "60,40", "--spacing-km", "0.5", "--product", "composite",
                     "--probe-at", "35.3,-97.6", "--json"}));
    EXPECT_EQ(json["probe"]["status"], "value");
    EXPECT_NEAR(json["probe"]["latitude_deg"].get<double>(), 35.3, 0.003);
    const auto outside =
        run({"frame", volume("KTLX19990503_235621.gz"), "--center", "35.3,-97.6", "--extent-km",
             "60,40", "--product", "composite", "--probe-at", "37,-97.6"});
    EXPECT_NE(outside.status, 0);
    EXPECT_THAT(outside.err, HasSubstr("outside"));
}

// Leaving out echo that is not weather removes the echo tops of migrating birds (the night of
// 2010-09-11), but keeps the VIL of rain.
TEST_F(FrameFiles, TopsAndVilAreThoseOfWeather) {
    const std::string night = (data_ / "mosaic-northeast" / "KOKX20100911_011047_V03.gz").native();
    const std::string rain = volume("KLBB20160601_150025_V06");
    const auto probe = [&](const std::string& file, const std::string& product,
                           const std::string& place, const std::string& quality) {
        return json_of(run({"frame", file, "--product", product, "--quality", quality, "--probe-at",
                            place, "--json"}))["probe"];
    };
    EXPECT_EQ(probe(night, "echotop", "42.1731,-73.4754", "0")["status"], "value");
    EXPECT_EQ(probe(night, "echotop", "42.1731,-73.4754", "0.5")["status"], "no_echo");
    const auto all = probe(rain, "vil", "33.6495,-102.3374", "0");
    const auto weather = probe(rain, "vil", "33.6495,-102.3374", "0.5");
    EXPECT_GT(all["value"].get<double>(), 10);
    EXPECT_EQ(weather["value"], all["value"]);
}

TEST_F(FrameFiles, OptionsOfTheGridAreForFiles) {
    ingest(volume("KTLX20170101_030027_V06"));
    const auto refused =
        run({"frame", "KTLX", "--cache", out("cache"), "--extent-km", "60,60", "-o", out("a.png")});
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr("for files"));
}

TEST_F(FrameFiles, TheServiceSaysWhereThingsAre) {
    ingest(volume("KTLX20170101_030027_V06"));
    // The only domain needs no name.
    const auto only = run(
        {"frame", "--config", out("config.toml"), "--product", "composite", "-o", out("a.png")});
    EXPECT_EQ(only.status, 0) << only.err;
    const auto list = run({"catalog", "list", "--config", out("config.toml")});
    EXPECT_THAT(list.out, HasSubstr("KTLX"));
    ASSERT_EQ(::setenv("STORMCELLAR_CONFIG", out("config.toml").c_str(), 1), 0);
    const auto by_variable = run({"cache", "stat"});
    const auto option_wins = run({"cache", "stat", "--cache", out("nowhere")});
    const auto named_wins = run({"cache", "stat", "--config", out("missing.toml")});
    ::unsetenv("STORMCELLAR_CONFIG");
    EXPECT_THAT(by_variable.out, HasSubstr("KTLX"));
    EXPECT_NE(option_wins.status, 0);
    EXPECT_THAT(option_wins.err, HasSubstr("nowhere"));
    EXPECT_THAT(named_wins.err, HasSubstr("missing.toml"));
}

TEST_F(FrameFiles, NothingSaysWhereTheCacheIs) {
    if (::access("/etc/stormcellar/stormcellard.toml", R_OK) == 0)
        GTEST_SKIP() << "this machine has a configured service";
    const auto lost = run({"frame", "KTLX", "-o", out("a.png")});
    EXPECT_EQ(lost.status, 2);
    EXPECT_THAT(lost.err, HasSubstr("'KTLX' names no file here"));
    EXPECT_THAT(lost.err, HasSubstr("--cache"));
    EXPECT_THAT(lost.err, HasSubstr("STORMCELLAR_CONFIG"));
}

}  // namespace
}  // namespace stormcellar::cli
