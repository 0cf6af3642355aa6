#include "stormcellar/render/still.h"

#include <algorithm>
#include <array>

#include <fmt/ranges.h>

#include "base/name_list.h"
#include "render/still/still_format.h"
#include "stormcellar/render/png_file.h"

namespace stormcellar::render {
namespace {

Result<std::vector<std::byte>> encode_as_png(const Image& picture, const StillOptions& options) {
    return encode_png(picture, options.metadata);
}

constexpr std::array<std::string_view, 1> png_endings{".png"};
constexpr std::array<std::string_view, 2> jpeg_endings{".jpg", ".jpeg"};
constexpr std::array<std::string_view, 1> webp_endings{".webp"};
constexpr std::array<std::string_view, 2> tiff_endings{".tif", ".tiff"};
constexpr std::array<std::string_view, 1> kmz_endings{".kmz"};

constexpr std::array formats{
    StillFormat{"PNG", png_endings, "image/png", encode_as_png, nullptr},
    StillFormat{"JPEG", jpeg_endings, "image/jpeg", encode_jpeg, nullptr},
    StillFormat{"WebP", webp_endings, "image/webp", encode_webp, nullptr},
    StillFormat{"GeoTIFF", tiff_endings, "image/tiff", nullptr, encode_geotiff},
    StillFormat{"KMZ", kmz_endings, "application/vnd.google-earth.kmz", nullptr, encode_kmz},
};

}  // namespace

std::optional<TiffContent> tiff_content_from_name(std::string_view name) {
    const auto* const found = std::ranges::find(tiff_contents, name, &TiffContentFacts::name);
    if (found == std::end(tiff_contents)) return std::nullopt;
    return found->content;
}

std::span<const StillFormat> still_formats() {
    return formats;
}

const StillFormat* still_format_of(std::string_view file_name) {
    for (const StillFormat& format : formats) {
        const auto fits = [&](std::string_view ending) { return file_name.ends_with(ending); };
        if (std::ranges::any_of(format.endings, fits)) return &format;
    }
    return nullptr;
}

std::vector<std::string_view> still_endings() {
    std::vector<std::string_view> all;
    for (const StillFormat& format : formats)
        all.insert(all.end(), format.endings.begin(), format.endings.end());
    return all;
}

std::string known_still_formats() {
    struct Named {
        std::string name;
    };
    std::vector<Named> known;
    for (const StillFormat& format : formats)
        known.push_back({fmt::format("{} ({})", format.name, fmt::join(format.endings, ", "))});
    return names_in(known, ", ", " or ");
}

Status check_picture(const Image& picture, int largest_side) {
    const auto pixels =
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    if (picture.width < 1 || picture.height < 1 || picture.rgba.size() != pixels * 4) {
        return fail(ErrorCode::bad_argument, "a picture of {} by {} pixels cannot have {} bytes",
                    picture.width, picture.height, picture.rgba.size());
    }
    if (picture.width > largest_side || picture.height > largest_side) {
        return fail(ErrorCode::bad_argument,
                    "a picture of {} by {} pixels is too large; this format allows {} along a side",
                    picture.width, picture.height, largest_side);
    }
    return {};
}

}  // namespace stormcellar::render
