// tests/render/decoded_animation.h -- writes test animations and reads them back with foreign
// decoders.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/render/animation.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

struct DecodedFrame {
    Image image;  // the whole canvas, with all earlier frames
    double start_s = 0;
    double duration_s = 0;
};

struct DecodedAnimation {
    std::string error{};  // empty: everything was read
    std::string codec{};
    std::vector<DecodedFrame> frames{};
    std::map<std::string, std::string> metadata{};  // by the decoder's names
    int loop_count = -1;                            // 0: forever; -1: the decoder does not say
};

// Writes a loop. The test fails if the loop cannot be written. The function is inline, because
// tests of stills have no writer of loops.
inline void write_animation(const std::string& path, const std::vector<Image>& frames,
                            const AnimationOptions& options = {}) {
    const auto writer = AnimationWriter::create(path, options);
    ASSERT_TRUE(writer) << writer.error().message;
    for (const Image& frame : frames)
        ASSERT_TRUE((*writer)->add(frame));
    const auto finished = (*writer)->finish();
    ASSERT_TRUE(finished) << finished.error().message;
}
// Expects these frames, pixel by pixel.
void expect_frames(const DecodedAnimation& animation, const std::vector<Image>& frames);

// Decodes with libwebp's WebPAnimDecoder. The XMP packet is metadata "XMP".
[[nodiscard]] DecodedAnimation decode_webp(const std::filesystem::path& path);
// Decodes GIF, APNG, MP4 and WebM with FFmpeg; only in a build with FFmpeg.
[[nodiscard]] DecodedAnimation decode_with_ffmpeg(const std::filesystem::path& path);
// Decodes with libpng's simplified reader. Returns an image of size 0 if it cannot be read.
[[nodiscard]] Image decode_png_file(const std::filesystem::path& path);

// Return frames in which a square moves over flat patches, with 20 opaque colors.
[[nodiscard]] Image test_frame(int index, int width = 61, int height = 43);
[[nodiscard]] std::vector<Image> test_frames(int count, int width = 61, int height = 43);

// Returns the largest difference of a channel, alpha included; 256 if the sizes differ.
[[nodiscard]] int largest_difference(const Image& a, const Image& b);

}  // namespace stormcellar::render
