// Marks storm cells in pictures of files and of a cache. Tests that pictures that cannot have marks
// are refused.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/loop_fixture.h"
#include "tests/render/decoded_animation.h"
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
    // Returns the message that refuses a picture.
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
    // A product of hail needs freezing levels, so the cells in its picture have MESH.
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

// The first warning is in force in the last two of the three volumes, the second warning in no
// volume.
constexpr const char* warnings = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature",
   "properties": {"event": "Tornado Warning", "onset": "2005-08-22T02:49:00Z",
                  "ends": "2005-08-22T03:15:00Z"},
   "geometry": {"type": "Polygon",
                "coordinates": [[[-77, 41.5], [-75, 41.5], [-75, 42.9], [-77, 41.5]]]}},
  {"type": "Feature",
   "properties": {"event": "Tornado Warning", "onset": "2006-08-22T02:49:00Z"},
   "geometry": {"type": "Point", "coordinates": [-76, 42]}}]})";

class ShapeOverlayPictures : public CellOverlayPictures {
  protected:
    void SetUp() override {
        CellOverlayPictures::SetUp();
        std::ofstream(out("warnings.geojson")) << warnings;
    }
    [[nodiscard]] std::string shapes_in(const std::string& file) const {
        return png_texts(out(file))["Shapes"];
    }
    [[nodiscard]] Words drawn(const std::string& overlay, const std::string& output) const {
        return {"--overlay", overlay,    "--product", "composite", "--width",
                "420",       "--height", "320",       "-o",        out(output)};
    }
};

TEST_F(ShapeOverlayPictures, DrawWhatIsInForce) {
    for (const auto& [volume, text] : {std::pair{0, "warnings.geojson: 0 of 2 in force"},
                                       {2, "warnings.geojson: 1 of 2 in force"}}) {
        const auto ran =
            run(with({"frame", files_[volume]}, drawn(out("warnings.geojson"), "a.png")));
        ASSERT_EQ(ran.status, 0) << ran.err;
        EXPECT_EQ(shapes_in("a.png"), text);
    }
    ASSERT_EQ(run({"frame", files_[2], "--product", "composite", "--width", "420", "--height",
                   "320", "-o", out("plain.png")})
                  .status,
              0);
    const auto with_shapes = render::decode_png_file(out("a.png"));
    const auto plain = render::decode_png_file(out("plain.png"));
    const auto red = [](const render::Image& image) {
        int count = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const render::Rgba8 p = image.at(x, y);
                if (p[0] > 240 && p[1] < 10 && p[2] < 10) ++count;
            }
        }
        return count;
    };
    EXPECT_GT(red(with_shapes), red(plain) + 40);
}

TEST_F(ShapeOverlayPictures, GoWithCellsInSceneFilesLoopsAndNowcasts) {
    const std::string both = "cells," + out("warnings.geojson");
    const auto frame = run(with({"frame"}, files_, drawn(both, "both.png")));
    ASSERT_EQ(frame.status, 0) << frame.err;
    EXPECT_EQ(shapes_in("both.png"), "warnings.geojson: 1 of 2 in force");
    EXPECT_THAT(png_texts(out("both.png"))["Storm cells"], HasSubstr("1 storm cell"));
    std::ofstream(out("scene.toml"))
        << "[picture]\nproduct = \"composite\"\noverlay = \"warnings.geojson\"\n";
    const auto scene =
        run({"frame", files_[2], "--scene", out("scene.toml"), "-o", out("scene.png")});
    ASSERT_EQ(scene.status, 0) << scene.err;
    EXPECT_EQ(shapes_in("scene.png"), "warnings.geojson: 1 of 2 in force");
    for (const char* product : {"composite", "ppi"}) {
        const std::string directory = std::string(product) + "/";
        const auto loop = run(with(
            {"loop"}, files_,
            {"--overlay", out("warnings.geojson"), "--product", product, "-o", out(directory)}));
        ASSERT_EQ(loop.status, 0) << loop.err;
        EXPECT_THAT(shapes_in(directory + "frame_0002.png"), HasSubstr("warnings.geojson"));
    }
    const auto nowcast =
        run(with({"nowcast"}, files_,
                 with(drawn(out("warnings.geojson"), "soon.png"), {"--minutes", "30"})));
    ASSERT_EQ(nowcast.status, 0) << nowcast.err;
    EXPECT_EQ(shapes_in("soon.png"), "warnings.geojson: 0 of 2 in force")
        << "half an hour after the last volume";
}

TEST_F(ShapeOverlayPictures, NameTheFileThatCannotBeRead) {
    const auto none = run(with({"frame", files_[0]}, drawn(out("none.geojson"), "b.png")));
    EXPECT_NE(none.status, 0);
    EXPECT_THAT(none.err, HasSubstr("none.geojson"));
    std::ofstream(out("bad.geojson")) << R"({"type": "Point", "coordinates": [1]})";
    const auto bad = run(with({"frame", files_[0]}, drawn(out("bad.geojson"), "b.png")));
    EXPECT_NE(bad.status, 0);
    EXPECT_THAT(bad.err, HasSubstr("bad.geojson: a position is no list of two numbers"));
    EXPECT_FALSE(std::filesystem::exists(out("b.png")));
}

TEST_F(CellOverlayPictures, RefuseWhatCannotHaveMarks) {
    EXPECT_THAT(refusal({"frame", files_[0], "--overlay", "storms", "-o", out("a.png")}),
                HasSubstr("--overlay: must be cells, or a file of GeoJSON"));
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
