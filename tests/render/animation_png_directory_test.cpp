#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/render/animation.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class PngDirectory : public ::testing::Test {
  protected:
    void write(int count) {
        const auto writer = AnimationWriter::create(output(), {});
        ASSERT_TRUE(writer) << writer.error().message;
        for (const Image& frame : test_frames(count))
            ASSERT_TRUE((*writer)->add(frame));
        ASSERT_TRUE((*writer)->finish());
    }
    [[nodiscard]] std::string output() const { return (directory_ / "frames/").string(); }
    testing::TemporaryDirectory directory_;
};

TEST_F(PngDirectory, HoldsOneNumberedFileAFrame) {
    write(3);
    for (int i = 0; i < 3; ++i) {
        const auto path = directory_ / ("frames/frame_000" + std::to_string(i) + ".png");
        EXPECT_EQ(decode_png_file(path).rgba, test_frame(i).rgba) << path;
    }
}

TEST_F(PngDirectory, ShorterLoopLeavesNoFrameOfTheOldOne) {
    write(5);
    write(2);
    EXPECT_TRUE(fs::exists(directory_ / "frames/frame_0001.png"));
    EXPECT_FALSE(fs::exists(directory_ / "frames/frame_0002.png"));
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_.path()), fs::directory_iterator()),
              1);
}

TEST_F(PngDirectory, DirectoryWithOtherFilesIsNotTouched) {
    fs::create_directory(directory_ / "frames");
    std::ofstream(directory_ / "frames/thesis.tex") << "years of work";
    const auto writer = AnimationWriter::create(output(), {});
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(writer.error().message, HasSubstr("thesis.tex"));
    EXPECT_TRUE(fs::exists(directory_ / "frames/thesis.tex"));
}

TEST_F(PngDirectory, FileOfThatNameIsNotReplaced) {
    std::ofstream(directory_ / "frames") << "a file";
    const auto writer = AnimationWriter::create(output(), {});
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().code, ErrorCode::not_a_file);
}

}  // namespace
}  // namespace stormcellar::render
