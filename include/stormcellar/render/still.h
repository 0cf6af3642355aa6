// stormcellar/render/still.h -- the formats of a single picture, and of a map as data for other
// programs.
//
// Formats of pictures encode the pixels of any product that render_frame() draws:
//   PNG      lossless; alpha is kept; metadata as tEXt chunks
//   JPEG     quality 92 without subsampling of colors; alpha is dropped; metadata as XMP
//   WebP     lossless; alpha is kept; metadata as XMP
// Formats of maps take a 2D product of a grid, without the map and the labels around it:
//   GeoTIFF  the values of the cells in the grid's own projection: a cloud-optimized file for GIS
//   netCDF   the values and states of the cells, in the same projection, as CF-1.8
//   GRIB2    the values of products for which WMO has a number, and their states, on grids in
//            latitude and longitude or Lambert's projection (export/grib_map.h)
//   KMZ      the map's colors over latitude and longitude, with a legend, for Google Earth
// Each format has one row in a registry. A writer of stills chooses the format by the name of the
// file; help and messages list the registry.
//
// Threads   Any thread may call.
// Errors    See each function.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/frame_facts.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// The kinds of pixels that a GeoTIFF may hold.
enum class TiffContent {
    values,  // float: the shown number in its unit; NaN where a column has no value
    states,  // byte: 0 not seen, 1 no echo, 2 range folded, 3 value, 4 value or more (tops)
    colors,  // red, green, blue, alpha: the colors of the color table
};
struct TiffContentFacts {
    TiffContent content = TiffContent::values;
    std::string_view name = {};
};
inline constexpr TiffContentFacts tiff_contents[] = {
    {TiffContent::values, "values"},
    {TiffContent::states, "states"},
    {TiffContent::colors, "colors"},
};
[[nodiscard]] std::optional<TiffContent> tiff_content_from_name(std::string_view name);

struct StillOptions {
    // Pairs of keyword and text, in ASCII. "Title" becomes the title if the format has one.
    std::vector<std::pair<std::string, std::string>> metadata{};
    TiffContent tiff = TiffContent::values;
    int threads = 1;
};

// A 2D product of a grid. The referenced objects must outlive the StillMap.
struct StillMap {
    const grid::BrickView& view;
    const FrameFacts& facts;
    const Scene& scene;  // its product is a map
};

struct StillFormat {
    std::string_view name;                      // "JPEG"
    std::span<const std::string_view> endings;  // of file names; the first is the usual one
    std::string_view media_type;                // "image/jpeg"
    // Exactly one of the two encoders is set. Errors: bad_argument for a picture that the format
    // cannot hold, for example because it is too large; internal if a library refuses.
    Result<std::vector<std::byte>> (*encode_picture)(const Image& picture,
                                                     const StillOptions& options) = nullptr;
    // Errors: bad_argument for a product that is no map, and those of check_frame(); unsupported
    // for a grid that the format cannot place, a product that it cannot name, and a build without
    // the format's library.
    Result<std::vector<std::byte>> (*encode_map)(const StillMap& map,
                                                 const StillOptions& options) = nullptr;
};

// Returns all formats. The first one is the default if no file name chooses one.
[[nodiscard]] std::span<const StillFormat> still_formats();
// Finds a format by the ending of a file's name. Returns null if no format has this ending.
[[nodiscard]] const StillFormat* still_format_of(std::string_view file_name);
// still_endings() returns the endings of all formats; known_still_formats() returns the names with
// their endings: "PNG (.png), JPEG (.jpg, .jpeg), ...".
[[nodiscard]] std::vector<std::string_view> still_endings();
[[nodiscard]] std::string known_still_formats();

}  // namespace stormcellar::render
