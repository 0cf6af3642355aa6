// Marks storm cells in pictures of files and of a cache, and refuses what cannot have marks.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/loop_fixture.h"
#include "tests/testing/small_sequence.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

// Three volumes of one storm, which moves by 15 m/s to the east and 5 to the north.
class CellOverlayPictures : public ::testing::Test {
  protected:
    void SetUp() override { files_ = testing::write_small_volumes(3, directory_.path()); }
    [[nodiscard]] std::string out(const std::string& name) const {
        return directory_.path() / name;
    }
    // Returns the options of a small picture with marks.
    [[nodiscard]] Words marked(const std::string& output, const Words& more = {}) const {
        return with({"--overlay", "cells", "--product", "composite", "--width", "420", "--height",
                     "320", "-o", out(output)},
                    more);
    }
    // Returns the sentence about storm cells in a PNG that was drawn.
    [[nodiscard]] std::string sentence(const Words& words, const std::string& output) const {
        const auto ran = run(words);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return png_texts(out(output))["Storm cells"];
    }
    // Returns the message with which a picture is refused.
    [[nodiscard]] static std::string refusal(const Words& words) {
        const auto ran = run(words);
        EXPECT_EQ(ran.status, 2) << ran.err;
        return ran.err;
    }

    testing::TemporaryDirectory directory_;
    Words files_;
};

TEST_F(CellOverlayPictures, FollowTheCellsThroughTheFiles) {
    const std::string all = sentence(with({"frame"}, files_, marked("all.png")), "all.png");
    EXPECT_THAT(all, HasSubstr("1 storm cell at 2005-08-22T02:55:49Z, followed through 3 volumes"));
    EXPECT_THAT(all, HasSubstr("peaks of 41 dBZ and more"));
    EXPECT_EQ(png_texts(out("all.png"))["First time"], "2005-08-22T02:55:49Z");
    const std::string one = sentence(with({"frame", files_[0]}, marked("one.png")), "one.png");
    EXPECT_THAT(one, HasSubstr("of one volume, so without motion and forecast"));
    EXPECT_EQ(sentence({"frame", files_[0], "-o", out("none.png")}, "none.png"), "");
}

TEST_F(CellOverlayPictures, MarkSweepsAndVolumesToo) {
    for (const char* product : {"ppi", "volume", "mesh"}) {
        const std::string file = std::string(product) + ".png";
        const Words words =
            with({"frame"}, files_, {"--overlay", "cells", "--product", product, "-o", out(file)});
        EXPECT_THAT(sentence(words, file), HasSubstr("followed through 3 volumes")) << product;
    }
    // A product of hail has freezing levels, and so its cells have MESH.
    EXPECT_THAT(png_texts(out("mesh.png"))["Storm cells"], HasSubstr("0 C at 4200 m"));
    EXPECT_EQ(png_texts(out("ppi.png"))["Storm cells"].find("0 C"), std::string::npos);
}

TEST_F(CellOverlayPictures, SceneFilesAndFreezingLevelsChooseMarks) {
    std::ofstream(out("scene.toml")) << "[picture]\nproduct = \"composite\"\noverlay = \"cells\"\n"
                                        "freezing_levels_m = [3000, 6100]\n";
    const Words words = with({"frame"}, files_, {"--scene", out("scene.toml"), "-o", out("a.png")});
    EXPECT_THAT(sentence(words, "a.png"), HasSubstr("MESH assumes 0 C at 3000 m, -20 C at 6100 m"));
}

TEST_F(CellOverlayPictures, LoopsAndNowcastsHaveMarks) {
    const auto loop = run(with({"loop"}, files_, marked("frames/")));
    ASSERT_EQ(loop.status, 0) << loop.err;
    EXPECT_THAT(png_texts(out("frames/frame_0002.png"))["Storm cells"],
                HasSubstr("peaks of 41 dBZ and more"));
    const auto sweeps = run(
        with({"loop"}, files_, {"--overlay", "cells", "--product", "ppi", "-o", out("sweeps/")}));
    ASSERT_EQ(sweeps.status, 0) << sweeps.err;
    EXPECT_THAT(png_texts(out("sweeps/frame_0002.png"))["Storm cells"],
                HasSubstr("peaks of 41 dBZ and more"));
    const std::string soon =
        sentence(with({"nowcast"}, files_, marked("soon.png", {"--minutes", "15"})), "soon.png");
    EXPECT_THAT(soon, HasSubstr("followed through 3 volumes"));
}

TEST_F(CellOverlayPictures, RefuseWhatCannotHaveMarks) {
    EXPECT_THAT(refusal({"frame", files_[0], "--overlay", "storms.geojson", "-o", out("a.png")}),
                HasSubstr("--overlay: must be cells, not 'storms.geojson'"));
    EXPECT_THAT(refusal(with({"frame", files_[0]}, marked("a.tif"))),
                HasSubstr("GeoTIFF holds data without marks"));
    EXPECT_THAT(refusal(with({"nowcast"}, files_, marked("a.nc"))),
                HasSubstr("holds data without marks"));
    EXPECT_THAT(refusal({"frame", files_[0], "--overlay", "cells", "--panels", "REF,VEL", "-o",
                         out("a.png")}),
                HasSubstr("not for --panels"));
    EXPECT_THAT(refusal({"frame", files_[0], "--overlay", "cells", "--product", "section",
                         "--section", "42,-76,42.5,-75.5", "-o", out("a.png")}),
                HasSubstr("section does not use it"));
    EXPECT_THAT(refusal({"frame", files_[0], "--product", "composite", "--freezing-levels",
                         "3000,6100", "-o", out("a.png")}),
                HasSubstr("beside an overlay of cells"));
    EXPECT_FALSE(std::filesystem::exists(out("a.png")));
}

}  // namespace
}  // namespace stormcellar::cli
