// tests/render/decoded_animation.h -- loops read back by decoders that are not ours.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "stormcellar/render/image.h"

namespace stormcellar::render {

struct DecodedFrame {
    Image image;  // the whole canvas, as it is shown
    double start_s = 0;
    double duration_s = 0;
};

struct DecodedAnimation {
    std::string error{};  // empty: all of it was read
    std::string codec{};
    std::vector<DecodedFrame> frames{};
    std::map<std::string, std::string> metadata{};  // as the decoder names it
    int loop_count = -1;                            // 0: for ever; -1: the decoder does not say
};

// By libwebp's WebPAnimDecoder. The XMP packet is metadata "XMP".
[[nodiscard]] DecodedAnimation decode_webp(const std::filesystem::path& path);
// By FFmpeg: GIF, APNG, MP4, WebM. Only where the build has it.
[[nodiscard]] DecodedAnimation decode_with_ffmpeg(const std::filesystem::path& path);
// By libpng's simplified reader; an image of no size when it cannot be read.
[[nodiscard]] Image decode_png_file(const std::filesystem::path& path);

// A square that moves over flat patches: 20 colours, opaque.
[[nodiscard]] Image test_frame(int index, int width = 61, int height = 43);
[[nodiscard]] std::vector<Image> test_frames(int count, int width = 61, int height = 43);

// The largest difference of a channel, alpha included; 256 when the sizes differ.
[[nodiscard]] int largest_difference(const Image& a, const Image& b);

}  // namespace stormcellar::render
