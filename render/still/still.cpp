#include "stormcellar/render/still.h"

#include <algorithm>
#include <array>

#include "base/format_list.h"
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
constexpr std::array<std::string_view, 2> netcdf_endings{".nc", ".nc4"};
constexpr std::array<std::string_view, 2> grib_endings{".grib2", ".grb2"};
constexpr std::array<std::string_view, 1> kmz_endings{".kmz"};

constexpr std::array formats{
    StillFormat{"PNG", png_endings, "image/png", encode_as_png, nullptr},
    StillFormat{"JPEG", jpeg_endings, "image/jpeg", encode_jpeg, nullptr},
    StillFormat{"WebP", webp_endings, "image/webp", encode_webp, nullptr},
    StillFormat{"GeoTIFF", tiff_endings, "image/tiff", nullptr, encode_geotiff},
    StillFormat{"netCDF", netcdf_endings, "application/x-netcdf", nullptr, encode_netcdf},
    StillFormat{"GRIB2", grib_endings, "application/wmo-grib2", nullptr, encode_grib},
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
    return find_format(still_formats(), file_name);
}

std::vector<std::string_view> still_endings() {
    return endings_in(still_formats());
}

std::string known_still_formats() {
    return formats_in(still_formats());
}

}  // namespace stormcellar::render
