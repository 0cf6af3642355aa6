// Reads stills back with libjpeg, libwebp and libpng. tests/render/still_gdal_test.cpp opens maps
// with GDAL.
#include "stormcellar/render/still.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <jpeglib.h>

#include "tests/render/decoded_animation.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

using ::testing::HasSubstr;

std::string text_in(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::byte> encode_with(std::string_view name, const Image& picture,
                                   const std::vector<std::pair<std::string, std::string>>& texts) {
    StillOptions options;
    options.metadata = texts;
    const auto bytes = still_format_of(name)->encode_picture(picture, options);
    EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error().message);
    return bytes.value_or(std::vector<std::byte>{});
}

Image decode_jpeg(const std::vector<std::byte>& bytes) {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&jpeg);
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    jpeg_start_decompress(&jpeg);
    Image image(static_cast<int>(jpeg.output_width), static_cast<int>(jpeg.output_height),
                {0, 0, 0, 255});
    std::vector<unsigned char> row(std::size_t{jpeg.output_width} * 3);
    for (int y = 0; y < image.height; ++y) {
        unsigned char* to = row.data();
        jpeg_read_scanlines(&jpeg, &to, 1);
        for (int x = 0; x < image.width; ++x) {
            const std::size_t at = static_cast<std::size_t>(x) * 3;
            image.set(x, y, {row[at], row[at + 1], row[at + 2], 255});
        }
    }
    jpeg_finish_decompress(&jpeg);
    jpeg_destroy_decompress(&jpeg);
    return image;
}

TEST(Still, TheEndingOfTheNameIsTheFormat) {
    EXPECT_EQ(still_formats().front().name, "PNG");
    EXPECT_EQ(still_format_of("a.jpeg")->name, "JPEG");
    EXPECT_EQ(still_format_of("/x.y/a.tiff")->name, "GeoTIFF");
    EXPECT_EQ(still_format_of("a.bmp"), nullptr);
    EXPECT_EQ(still_format_of("png"), nullptr);
    EXPECT_EQ(known_still_formats(),
              "PNG (.png), JPEG (.jpg, .jpeg), WebP (.webp), GeoTIFF (.tif, .tiff), netCDF (.nc, "
              ".nc4), GRIB2 (.grib2, .grb2) or KMZ (.kmz)");
    for (const StillFormat& format : still_formats())
        EXPECT_NE(format.encode_picture == nullptr, format.encode_map == nullptr) << format.name;
}

TEST(Still, JpegKeepsColorsApartAndItsTexts) {
    const Image frame = test_frame(0, 160, 120);
    const auto bytes = encode_with("a.jpg", frame, {{"Title", "A & B"}, {"Domain", "KTLX"}});
    const Image back = decode_jpeg(bytes);
    ASSERT_EQ(back.width, 160);
    ASSERT_EQ(back.height, 120);
    double sum = 0;
    for (std::size_t i = 0; i < frame.rgba.size(); ++i)
        sum += std::pow(double{1} * frame.rgba[i] - back.rgba[i], 2);
    EXPECT_LT(std::sqrt(sum / static_cast<double>(frame.rgba.size())), 3);
    EXPECT_THAT(text_in(bytes), HasSubstr("http://ns.adobe.com/xap/1.0/"));
    EXPECT_THAT(text_in(bytes), HasSubstr("A &amp; B"));
    EXPECT_THAT(text_in(bytes), HasSubstr("Domain: KTLX"));
}

TEST(Still, TextsThatAJpegHasNoRoomForAreReducedToTheTitle) {
    const auto bytes = encode_with("a.jpg", test_frame(0),
                                   {{"Title", "KTLX"}, {"Sources", std::string(100'000, 'x')}});
    EXPECT_EQ(decode_jpeg(bytes).width, 61);
    EXPECT_THAT(text_in(bytes), HasSubstr("KTLX"));
    EXPECT_LT(bytes.size(), 50'000U);
}

TEST(Still, EveryPixelOfWebpComesBack) {
    Image frame = test_frame(2);
    frame.set(5, 6, {10, 20, 30, 0});
    frame.set(7, 6, {10, 20, 30, 100});
    const auto bytes = encode_with("a.webp", frame, {{"Title", "A <x>"}});
    const testing::TemporaryDirectory directory;
    std::ofstream(directory / "a.webp", std::ios::binary) << text_in(bytes);
    const DecodedAnimation back = decode_webp(directory / "a.webp");
    ASSERT_EQ(back.frames.size(), 1U) << back.error;
    EXPECT_EQ(back.frames[0].image.rgba, frame.rgba);
    EXPECT_THAT(back.metadata.at("XMP"), HasSubstr("A &lt;x&gt;"));
}

TEST(Still, TheSamePictureGivesTheSameBytes) {
    for (const char* name : {"a.png", "a.jpg", "a.webp"})
        EXPECT_EQ(encode_with(name, test_frame(0), {}), encode_with(name, test_frame(0), {}));
}

TEST(Still, APictureThatIsTooLargeIsRefused) {
    const StillFormat& webp = *still_format_of("a.webp");
    const auto wide = webp.encode_picture(Image(20'000, 1, {0, 0, 0, 255}), {});
    ASSERT_FALSE(wide);
    EXPECT_EQ(wide.error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(still_format_of("a.jpg")->encode_picture(Image{}, {}));
    Image torn(4, 4, {0, 0, 0, 255});
    torn.rgba.pop_back();
    EXPECT_FALSE(webp.encode_picture(torn, {}));
}

}  // namespace
}  // namespace stormcellar::render
