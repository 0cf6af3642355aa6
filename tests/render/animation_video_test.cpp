#include <fstream>

#include <gtest/gtest.h>

#include "stormcellar/render/animation.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

class AnimationVideo : public ::testing::TestWithParam<std::string> {
  protected:
    void write(const std::vector<Image>& frames, const AnimationOptions& options = {}) {
        write_animation(path(), frames, options);
    }
    [[nodiscard]] std::string path() const { return (directory_ / ("a." + GetParam())).string(); }
    testing::TemporaryDirectory directory_;
};

// In the middle of flat patches, halved chroma has no effect: red stays red, and blue stays blue.
TEST_P(AnimationVideo, ColorsAndTheirPlacesComeBack) {
    const auto frames = test_frames(6, 160, 96);
    write(frames, {.last_frame_dwell_s = 0});
    const auto back = decode_with_ffmpeg(path());
    ASSERT_EQ(back.error, "");
    ASSERT_EQ(back.frames.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
        const Image& image = back.frames[i].image;
        ASSERT_EQ(image.width, 160);
        ASSERT_EQ(image.height, 96);
        for (int y = 40; y < 96; y += 16) {  // below the square
            for (int x = 8; x < 160; x += 16) {
                for (std::size_t c = 0; c < 3; ++c) {
                    EXPECT_NEAR(image.at(x, y)[c], frames[i].at(x, y)[c], 6)
                        << "frame " << i << ' ' << x << ' ' << y << " channel " << c;
                }
            }
        }
        const int square = 8 + 5 * static_cast<int>(i);
        EXPECT_NEAR(image.at(square, 16)[0], 255, 8);
        EXPECT_NEAR(image.at(square, 16)[1], 144, 8);
        EXPECT_NEAR(image.at(square, 16)[2], 0, 12);
    }
}

TEST_P(AnimationVideo, LastFrameIsShownAgainForItsDwell) {
    write(test_frames(3, 64, 48), {.frames_per_second = 4, .last_frame_dwell_s = 1.5});
    const auto back = decode_with_ffmpeg(path());
    ASSERT_EQ(back.frames.size(), 3U + 6U);
    for (std::size_t i = 0; i < back.frames.size(); ++i)
        EXPECT_NEAR(back.frames[i].start_s, 0.25 * static_cast<double>(i), 2e-3) << i;
    for (std::size_t i = 3; i < 9; ++i)
        EXPECT_LE(largest_difference(back.frames[i].image, back.frames[2].image), 12) << i;
}

TEST_P(AnimationVideo, OddSizesHaveTheirLastColumnAndRowTwice) {
    const auto frames = test_frames(2, 61, 43);
    write(frames);
    const auto back = decode_with_ffmpeg(path());
    ASSERT_FALSE(back.frames.empty());
    const Image& image = back.frames[0].image;
    EXPECT_EQ(image.width, 62);
    EXPECT_EQ(image.height, 44);
    EXPECT_NEAR(image.at(61, 5)[0], frames[0].at(60, 5)[0], 8);
    EXPECT_NEAR(image.at(40, 43)[0], frames[0].at(40, 42)[0], 8);
}

TEST_P(AnimationVideo, TitleIsInTheFile) {
    write(test_frames(2, 64, 48), {.metadata = {{"Title", "KBGM 2005"}}});
    EXPECT_EQ(decode_with_ffmpeg(path()).metadata["title"], "KBGM 2005");
}

INSTANTIATE_TEST_SUITE_P(Containers, AnimationVideo, ::testing::Values("mp4", "webm"),
                         [](const auto& parameter) { return parameter.param; });

// The index comes first, so that a browser can begin before it has the whole file.
TEST(AnimationMp4, IndexStandsBeforeThePictures) {
    const testing::TemporaryDirectory directory;
    const std::string path = (directory / "a.mp4").string();
    write_animation(path, test_frames(30, 64, 48));
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    ASSERT_NE(bytes.find("moov"), std::string::npos);
    EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

}  // namespace
}  // namespace stormcellar::render
