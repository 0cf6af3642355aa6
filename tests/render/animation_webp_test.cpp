#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/render/animation.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

using ::testing::HasSubstr;

DecodedAnimation round_trip(const std::vector<Image>& frames, const AnimationOptions& options) {
    const testing::TemporaryDirectory directory;
    const std::string path = (directory / "a.webp").string();
    write_animation(path, frames, options);
    return decode_webp(path);
}

TEST(AnimationWebp, EveryPixelComesBack) {
    const auto frames = test_frames(6);
    const auto back = round_trip(frames, {});
    expect_frames(back, frames);
    EXPECT_EQ(back.loop_count, 0);
}

TEST(AnimationWebp, LastFrameStaysLonger) {
    const auto back =
        round_trip(test_frames(3), {.frames_per_second = 4, .last_frame_dwell_s = 1.5});
    ASSERT_EQ(back.frames.size(), 3U);
    EXPECT_DOUBLE_EQ(back.frames[0].duration_s, 0.25);
    EXPECT_DOUBLE_EQ(back.frames[1].duration_s, 0.25);
    EXPECT_DOUBLE_EQ(back.frames[2].duration_s, 1.75);
}

TEST(AnimationWebp, AlphaIsKept) {
    Image frame = test_frame(0);
    frame.set(5, 6, {10, 20, 30, 0});
    frame.set(7, 6, {10, 20, 30, 100});
    const auto back = round_trip({frame, test_frame(1)}, {});
    ASSERT_EQ(back.frames.size(), 2U);
    EXPECT_EQ(back.frames[0].image.at(5, 6)[3], 0);
    EXPECT_EQ(back.frames[0].image.at(7, 6)[3], 100);
}

TEST(AnimationWebp, MetadataIsXmpWithItsLettersEscaped) {
    const auto back = round_trip(test_frames(2), {.metadata = {{"Title", "A & B <x>"}}});
    ASSERT_EQ(back.frames.size(), 2U);
    EXPECT_THAT(back.metadata.at("XMP"), HasSubstr("A &amp; B &lt;x&gt;"));
}

}  // namespace
}  // namespace stormcellar::render
