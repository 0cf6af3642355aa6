#include <gtest/gtest.h>

#include "stormcellar/render/animation.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

class AnimationApng : public ::testing::Test {
  protected:
    void write(const std::vector<Image>& frames, const AnimationOptions& options = {}) {
        const auto writer = AnimationWriter::create(path(), options);
        ASSERT_TRUE(writer) << writer.error().message;
        for (const Image& frame : frames)
            ASSERT_TRUE((*writer)->add(frame));
        ASSERT_TRUE((*writer)->finish());
    }
    [[nodiscard]] std::string path() const { return (directory_ / "a.apng").string(); }
    testing::TemporaryDirectory directory_;
};

TEST_F(AnimationApng, EveryPixelComesBack) {
    const auto frames = test_frames(6);
    write(frames);
    const auto back = decode_with_ffmpeg(path());
    ASSERT_EQ(back.error, "");
    EXPECT_EQ(back.codec, "apng");
    ASSERT_EQ(back.frames.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(back.frames[i].image.rgba, frames[i].rgba) << i;
}

TEST_F(AnimationApng, AlphaThatComesAndGoesIsKept) {
    auto frames = test_frames(4);
    frames[1].set(5, 6, {10, 20, 30, 0});
    frames[2].set(7, 6, {10, 20, 30, 100});
    write(frames);
    const auto back = decode_with_ffmpeg(path());
    ASSERT_EQ(back.frames.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(back.frames[i].image.rgba, frames[i].rgba) << i;
}

TEST_F(AnimationApng, IsAPngOfItsFirstFrameForOlderReaders) {
    write(test_frames(3));
    EXPECT_EQ(decode_png_file(path()).rgba, test_frame(0).rgba);
}

TEST_F(AnimationApng, LastFrameStaysLonger) {
    write(test_frames(3), {.frames_per_second = 4, .last_frame_dwell_s = 1.5});
    const auto back = decode_with_ffmpeg(path());
    ASSERT_EQ(back.frames.size(), 3U);
    EXPECT_NEAR(back.frames[1].start_s, 0.25, 1e-6);
    EXPECT_NEAR(back.frames[2].start_s, 0.5, 1e-6);
    EXPECT_NEAR(back.frames[2].duration_s, 1.75, 1e-6);
}

TEST_F(AnimationApng, MetadataIsText) {
    write(test_frames(2), {.metadata = {{"Title", "KBGM"}}});
    EXPECT_EQ(decode_with_ffmpeg(path()).metadata["Title"], "KBGM");
}

}  // namespace
}  // namespace stormcellar::render
