#include "stormcellar/render/png_file.h"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

namespace stormcellar::render {
namespace {

// libpng's own simplified reader is the reference.
Image decode(const std::vector<std::byte>& bytes) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) return {};
    png.format = PNG_FORMAT_RGBA;
    Image image(static_cast<int>(png.width), static_cast<int>(png.height), {});
    png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr);
    return image;
}

TEST(EncodePng, EveryPixelComesBack) {
    Image image(37, 11, {});
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            image.set(x, y,
                      {static_cast<std::uint8_t>(x * 7), static_cast<std::uint8_t>(y * 23),
                       static_cast<std::uint8_t>(x ^ y), static_cast<std::uint8_t>(255 - x)});
        }
    }
    const auto bytes = encode_png(image);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const Image back = decode(*bytes);
    EXPECT_EQ(back.width, 37);
    EXPECT_EQ(back.height, 11);
    EXPECT_EQ(back.rgba, image.rgba);
}

TEST(EncodePng, OpaqueImagesComeBackToo) {
    Image image(5, 7, {0, 0, 0, 255});
    for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 5; ++x) {
            image.set(x, y,
                      {static_cast<std::uint8_t>(x * 50), static_cast<std::uint8_t>(y * 30),
                       static_cast<std::uint8_t>(x + y), 255});
        }
    }
    const auto bytes = encode_png(image);
    ASSERT_TRUE(bytes);
    EXPECT_EQ(decode(*bytes).rgba, image.rgba);
    EXPECT_EQ(std::to_integer<int>((*bytes)[25]), PNG_COLOR_TYPE_RGB)
        << "the header gives the color type";
}

TEST(EncodePng, TextsBecomeTextChunks) {
    const auto bytes =
        encode_png(Image(1, 1, {}), {{"Title", "KTLX"}, {"Software", "stormcellar"}});
    ASSERT_TRUE(bytes);
    std::string text(bytes->size(), ' ');
    std::memcpy(text.data(), bytes->data(), bytes->size());
    using namespace std::string_literals;
    EXPECT_THAT(text, testing::HasSubstr("tEXtTitle\0KTLX"s));
    EXPECT_THAT(text, testing::HasSubstr("tEXtSoftware\0stormcellar"s));
}

TEST(EncodePng, TheSameImageGivesTheSameBytes) {
    const Image image(20, 20, {1, 2, 3, 255});
    EXPECT_EQ(encode_png(image, {{"Title", "x"}}).value(),
              encode_png(image, {{"Title", "x"}}).value());
}

TEST(EncodePng, RefusesWhatIsNotAnImage) {
    Image short_of_bytes(4, 4, {});
    short_of_bytes.rgba.pop_back();
    for (const Image& image : {Image{}, short_of_bytes}) {
        const auto bytes = encode_png(image);
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().code, ErrorCode::bad_argument);
    }
    using namespace std::string_literals;
    EXPECT_FALSE(encode_png(Image(1, 1, {}), {{"", "x"}}));
    EXPECT_FALSE(encode_png(Image(1, 1, {}), {{"Title", "a\0b"s}}));
}

}  // namespace
}  // namespace stormcellar::render
