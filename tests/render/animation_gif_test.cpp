#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/render/animation.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

using ::testing::HasSubstr;

class AnimationGif : public ::testing::Test {
  protected:
    DecodedAnimation round_trip(const std::vector<Image>& frames,
                                const AnimationOptions& options = {}) {
        write_animation(path(), frames, options);
        return decode_with_ffmpeg(path());
    }
    [[nodiscard]] std::string path() const { return (directory_ / "a.gif").string(); }
    testing::TemporaryDirectory directory_;
};

TEST_F(AnimationGif, FewColorsComeBackExactly) {
    const auto frames = test_frames(6);
    const auto back = round_trip(frames);
    EXPECT_EQ(back.codec, "gif");
    expect_frames(back, frames);
}

// Noise fills the code table and restarts it many times. The width of codes depends on the number
// of colors.
TEST_F(AnimationGif, NoiseOfAnyNumberOfColorsComesBackExactly) {
    std::mt19937 random(20261121);
    for (const unsigned colors : {1U, 2U, 3U, 4U, 7U, 8U, 15U, 16U, 100U, 254U, 255U}) {
        std::vector<Image> frames(2, Image(150, 110, {0, 0, 0, 255}));
        for (Image& frame : frames) {
            for (int y = 0; y < frame.height; ++y) {
                for (int x = 0; x < frame.width; ++x) {
                    const auto entry = static_cast<std::uint8_t>(random() % colors);
                    frame.set(x, y, {entry, static_cast<std::uint8_t>(255 - entry), 9, 255});
                }
            }
        }
        SCOPED_TRACE(colors);
        expect_frames(round_trip(frames), frames);
    }
}

TEST_F(AnimationGif, ColorThatStandsStillDoesNotFlicker) {
    std::vector<Image> frames(3, Image(128, 128, {}));
    for (int i = 0; i < 3; ++i) {
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                // The left half does not change, the right half does; there are thousands of
                // colors.
                const int shift = x < 64 ? 0 : 40 * i;
                frames[static_cast<std::size_t>(i)].set(
                    x, y,
                    {static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(2 * y),
                     static_cast<std::uint8_t>((x + y + shift) % 256), 255});
            }
        }
    }
    const auto back = round_trip(frames);
    ASSERT_EQ(back.frames.size(), 3U);
    std::set<Rgba8> shown;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            for (const auto& frame : back.frames)
                shown.insert(frame.image.at(x, y));
            if (x >= 64) continue;
            EXPECT_EQ(back.frames[1].image.at(x, y), back.frames[0].image.at(x, y));
            EXPECT_EQ(back.frames[2].image.at(x, y), back.frames[0].image.at(x, y));
        }
    }
    EXPECT_LE(shown.size(), 255U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LE(largest_difference(back.frames[i].image, frames[i]), 40) << i;
}

TEST_F(AnimationGif, LastFrameStaysLongerAndTheLoopIsForEver) {
    const auto back =
        round_trip(test_frames(3), {.frames_per_second = 4, .last_frame_dwell_s = 1.5});
    ASSERT_EQ(back.frames.size(), 3U);
    EXPECT_NEAR(back.frames[0].duration_s, 0.25, 1e-9);
    EXPECT_NEAR(back.frames[1].start_s, 0.25, 1e-9);
    EXPECT_NEAR(back.frames[2].duration_s, 1.75, 1e-9);
    const auto bytes = read_file(path());
    const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    using namespace std::string_literals;
    EXPECT_THAT(text, HasSubstr("NETSCAPE2.0\x03\x01\0\0\0"s));
}

TEST_F(AnimationGif, MetadataIsAComment) {
    const std::string long_text(700, 'x');  // longer than a sub-block
    const auto back =
        round_trip(test_frames(2), {.metadata = {{"Title", "KBGM"}, {"Description", long_text}}});
    EXPECT_EQ(back.metadata.at("comment"), "Title: KBGM\nDescription: " + long_text);
}

TEST_F(AnimationGif, FramesThatDoNotChangeAreStillFrames) {
    const auto back = round_trip(std::vector<Image>(4, test_frame(0)));
    ASSERT_EQ(back.frames.size(), 4U);
    EXPECT_EQ(back.frames[3].image.rgba, test_frame(0).rgba);
}

}  // namespace
}  // namespace stormcellar::render
