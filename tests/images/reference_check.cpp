#include "tests/images/reference_check.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <png.h>

#include "tests/images/picture_difference.h"
#include "tests/testing/data.h"

namespace stormcellar::images {
namespace {

namespace fs = std::filesystem;
using render::Image;

fs::path reference_path(const std::string& name) {
    return testing::source_directory() / "tests/images/references" / (name + ".png");
}

// Writes a PNG with zlib's best compression, because references are kept in Git.
// render::encode_png() prefers speed, and libpng's simplified writer has no setting for it.
bool write(const fs::path& path, const Image& image) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) return false;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    if (setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        std::fclose(file);
        return false;
    }
    png_init_io(png, file);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_compression_level(png, 9);
    png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
                 static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_set_filler(png, 0, PNG_FILLER_AFTER);
    for (int y = 0; y < image.height; ++y) {
        png_write_row(png, image.rgba.data() + static_cast<std::size_t>(y) *
                                                   static_cast<std::size_t>(image.width) * 4);
    }
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return std::fclose(file) == 0;
}

// Writes the pictures into a new directory, which stays, so that a person can look at them. Returns
// its path.
std::string store_for_looking(const Image& picture, const Result<Image>& reference) {
    std::string directory = (fs::temp_directory_path() / "stormcellar-images-XXXXXX").string();
    if (::mkdtemp(directory.data()) == nullptr) return "no temporary directory";
    bool stored = write(fs::path(directory) / "actual.png", picture);
    if (reference) {
        stored &= write(fs::path(directory) / "reference.png", *reference);
        if (reference->width == picture.width && reference->height == picture.height) {
            stored &= write(fs::path(directory) / "difference.png",
                            picture_of_difference(picture, *reference));
        }
    }
    return stored ? directory : directory + " (not all could be written)";
}

}  // namespace

Result<Image> read_reference(const std::string& name) {
    const std::string path = reference_path(name).string();
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&png, path.c_str()) == 0) {
        return fail(ErrorCode::not_found, "{}: {}", path, png.message);
    }
    png.format = PNG_FORMAT_RGBA;
    Image image(static_cast<int>(png.width), static_cast<int>(png.height), {});
    if (png_image_finish_read(&png, nullptr, image.rgba.data(), 0, nullptr) == 0) {
        return fail(ErrorCode::corrupt, "{}: {}", path, png.message);
    }
    return image;
}

::testing::AssertionResult matches_reference(const Image& picture, const std::string& name) {
    const auto reference = read_reference(name);
    Result<PictureDifference> difference = fail(ErrorCode::not_found, "no reference");
    if (reference) difference = difference_of(picture, *reference);
    if (difference && within(*difference)) return ::testing::AssertionSuccess();
    if (std::getenv("STORMCELLAR_UPDATE_REFERENCES") != nullptr) {
        if (!write(reference_path(name), picture)) {
            return ::testing::AssertionFailure() << reference_path(name) << " cannot be written";
        }
        return ::testing::AssertionSuccess();
    }
    ::testing::AssertionResult failure = ::testing::AssertionFailure();
    if (difference) {
        failure << "99 % of the pixels within " << difference->percentile_99 << ", "
                << 100 * difference->visible_share << " % visibly different, worst tile "
                << difference->worst_tile << " at " << difference->tile_x << ","
                << difference->tile_y;
    } else {
        failure << (reference ? difference.error() : reference.error()).message;
    }
    return failure << "; look at " << store_for_looking(picture, reference)
                   << ", and if the picture is meant to be so: scripts/update-image-references";
}

}  // namespace stormcellar::images
