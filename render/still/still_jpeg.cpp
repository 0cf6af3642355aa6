// Writes JPEG with libjpeg. Colors are data, so they are not subsampled, and the quality is high
// enough to keep the classes of a color table distinct.
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>

#include <jpeglib.h>

#include "render/image/check_size.h"
#include "render/image/xmp.h"
#include "render/still/still_format.h"

namespace stormcellar::render {
namespace {

constexpr int quality = 92;
constexpr std::size_t most_marker_bytes = 65533;  // 65535, less two for the length itself

struct JpegErrors {
    jpeg_error_mgr manager{};  // the first member, because libjpeg hands back its address
    std::jmp_buf jump{};
    std::array<char, JMSG_LENGTH_MAX> message{};
};

[[noreturn]] void leave(j_common_ptr jpeg) {
    auto* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
    errors->manager.format_message(jpeg, errors->message.data());
    std::longjmp(errors->jump, 1);
}

void say_nothing(j_common_ptr /*jpeg*/) {}

struct JpegBytes {
    unsigned char* data = nullptr;
    unsigned long size = 0;
};

// Uses only C calls and trivial objects, because libjpeg calls longjmp if it fails.
bool write_jpeg(jpeg_compress_struct& jpeg, JpegErrors& errors, const Image& image,
                std::span<const unsigned char> xmp, unsigned char* row, JpegBytes& bytes) {
    if (setjmp(errors.jump) != 0) return false;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes.data, &bytes.size);
    jpeg.image_width = static_cast<JDIMENSION>(image.width);
    jpeg.image_height = static_cast<JDIMENSION>(image.height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    jpeg.comp_info[0].h_samp_factor = 1;
    jpeg.comp_info[0].v_samp_factor = 1;
    jpeg.optimize_coding = TRUE;
    jpeg_start_compress(&jpeg, TRUE);
    if (!xmp.empty()) {
        jpeg_write_marker(&jpeg, JPEG_APP0 + 1, xmp.data(), static_cast<unsigned int>(xmp.size()));
    }
    const auto width = static_cast<std::size_t>(image.width);
    while (jpeg.next_scanline < jpeg.image_height) {
        const std::uint8_t* from = image.rgba.data() + jpeg.next_scanline * width * 4;
        for (std::size_t x = 0; x < width; ++x) {
            row[3 * x] = from[4 * x];
            row[3 * x + 1] = from[4 * x + 1];
            row[3 * x + 2] = from[4 * x + 2];
        }
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
}

// Returns the content of the marker APP1: a name, a zero byte and the XMP packet (XMP
// specification, part 3). If the texts are too long for one marker, only the title is kept.
std::string xmp_marker(const PictureTexts& texts) {
    if (texts.empty()) return {};
    const auto marker = [](const PictureTexts& kept) {
        std::string bytes{"http://ns.adobe.com/xap/1.0/"};
        bytes.push_back('\0');
        bytes += "<?xpacket begin=\"\xEF\xBB\xBF\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>";
        bytes += xmp_packet(kept);
        bytes += "<?xpacket end=\"r\"?>";
        return bytes;
    };
    std::string whole = marker(texts);
    if (whole.size() > most_marker_bytes) whole = marker({{"Title", title_of(texts)}});
    return whole.size() > most_marker_bytes ? std::string{} : whole;
}

}  // namespace

Result<std::vector<std::byte>> encode_jpeg(const Image& picture, const StillOptions& options) {
    if (auto fits = check_size(picture, JPEG_MAX_DIMENSION, "picture"); !fits) return pass_on(fits);
    JpegErrors errors;
    jpeg_compress_struct jpeg{};
    jpeg.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = leave;
    errors.manager.output_message = say_nothing;
    const std::string marker = xmp_marker(options.metadata);
    const std::span xmp(reinterpret_cast<const unsigned char*>(marker.data()), marker.size());
    std::vector<unsigned char> row(static_cast<std::size_t>(picture.width) * 3);
    JpegBytes bytes;
    const bool written = write_jpeg(jpeg, errors, picture, xmp, row.data(), bytes);
    jpeg_destroy_compress(&jpeg);
    const std::unique_ptr<unsigned char, decltype(&std::free)> owner(bytes.data, &std::free);
    if (!written) return fail(ErrorCode::internal, "JPEG: {}", errors.message.data());
    const auto all = std::as_bytes(std::span(bytes.data, bytes.size));
    return std::vector<std::byte>(all.begin(), all.end());
}

}  // namespace stormcellar::render
