// Draws rotation and its tracks from raw files. Tests that tracks refuse files of two radars, and a
// single grid from a cache.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/files_and_service.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

class RotationPictures : public FilesAndService {
  protected:
    // Returns the JSON of a frame with a probe at the tornado of Moore.
    [[nodiscard]] nlohmann::json probe(Words words) const {
        words.insert(words.begin(), {"frame", "--json", "--probe-at", "35.25,-97.69"});
        return json_of(run(words));
    }
};

TEST_F(RotationPictures, ShowTheTornadoOfMoore) {
    const std::string moore = volume("KTLX19990503_235621.gz");
    const auto low = probe({moore, "--product", "rotation", "-o", out("a.png")});
    EXPECT_EQ(low["moment"], "AZSH");
    EXPECT_EQ(low["probe"]["unit"], "0.001/s");
    EXPECT_GT(low["probe"]["value"].get<double>(), 10);
    EXPECT_TRUE(fs::exists(out("a.png")));
    // The tracks of one volume are its rotation.
    const auto track = probe({moore, "--product", "rotation-tracks"});
    EXPECT_EQ(track["probe"]["value"], low["probe"]["value"]);
}

TEST_F(RotationPictures, RefuseTracksOfTwoRadarsAndOfASingleGrid) {
    const auto two_radars =
        run({"frame", volume("KTLX19990503_235621.gz"), volume("KLBB20160601_150025_V06"),
             "--product", "rotation-tracks", "-o", out("a.png")});
    EXPECT_NE(two_radars.status, 0);
    EXPECT_THAT(two_radars.err, HasSubstr("must have the same radar, place and size"));
    ingest(volume("KTLX19990503_235621.gz"));
    const auto kept = run({"frame", "KTLX", "--cache", out("cache"), "--product", "rotation-tracks",
                           "-o", out("a.png")});
    EXPECT_NE(kept.status, 0);
    EXPECT_THAT(kept.err, HasSubstr("are made from several volumes"));
    EXPECT_FALSE(fs::exists(out("a.png")));
}

}  // namespace
}  // namespace stormcellar::cli
