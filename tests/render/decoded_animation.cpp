#include "tests/render/decoded_animation.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>
#include <png.h>
#include <webp/demux.h>

#include "stormcellar/base/file_system.h"

namespace stormcellar::render {

void expect_frames(const DecodedAnimation& animation, const std::vector<Image>& frames) {
    ASSERT_EQ(animation.error, "");
    ASSERT_EQ(animation.frames.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i)
        EXPECT_EQ(animation.frames[i].image.rgba, frames[i].rgba) << i;
}

DecodedAnimation decode_webp(const std::filesystem::path& path) {
    DecodedAnimation result;
    const auto bytes = read_file(path);
    if (!bytes) return {.error = bytes.error().message};
    const WebPData data{reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()};
    WebPAnimDecoder* decoder = WebPAnimDecoderNew(&data, nullptr);
    if (decoder == nullptr) return {.error = "libwebp does not read it"};
    WebPAnimInfo info;
    WebPAnimDecoderGetInfo(decoder, &info);
    result.codec = "webp";
    result.loop_count = static_cast<int>(info.loop_count);
    double start_s = 0;
    while (WebPAnimDecoderHasMoreFrames(decoder) != 0) {
        std::uint8_t* rgba = nullptr;
        int end_ms = 0;
        if (WebPAnimDecoderGetNext(decoder, &rgba, &end_ms) == 0) {
            result.error = "libwebp stops at a frame";
            break;
        }
        Image image(static_cast<int>(info.canvas_width), static_cast<int>(info.canvas_height), {});
        std::copy_n(rgba, image.rgba.size(), image.rgba.begin());
        result.frames.push_back({std::move(image), start_s, end_ms / 1e3 - start_s});
        start_s = end_ms / 1e3;
    }
    const WebPDemuxer* demuxer = WebPAnimDecoderGetDemuxer(decoder);
    WebPChunkIterator chunk;
    if (WebPDemuxGetChunk(demuxer, "XMP ", 1, &chunk) != 0) {
        result.metadata["XMP"].assign(reinterpret_cast<const char*>(chunk.chunk.bytes),
                                      chunk.chunk.size);
        WebPDemuxReleaseChunkIterator(&chunk);
    }
    WebPAnimDecoderDelete(decoder);
    return result;
}

Image decode_png_file(const std::filesystem::path& path) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&png, path.c_str()) == 0) return {};
    png.format = PNG_FORMAT_RGBA;
    Image image(static_cast<int>(png.width), static_cast<int>(png.height), {});
    png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr);
    return image;
}

Image test_frame(int index, int width, int height) {
    Image image(width, height, {10, 12, 16, 255});
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int patch = x / 16 + 4 * (y / 16);
            const auto level = static_cast<std::uint8_t>(40 + 12 * (patch % 16));
            const bool square = x >= 2 + 5 * index && x < 14 + 5 * index && y >= 8 && y < 24;
            if (square) {
                image.set(x, y, {255, 144, 0, 255});
            } else if (patch % 2 == 0) {
                image.set(x, y, {level, 30, static_cast<std::uint8_t>(255 - level), 255});
            }
        }
    }
    return image;
}

std::vector<Image> test_frames(int count, int width, int height) {
    std::vector<Image> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back(test_frame(i, width, height));
    return frames;
}

int largest_difference(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height) return 256;
    int largest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
    return largest;
}

}  // namespace stormcellar::render
