// render/still/tiff_file.h -- writes cloud-optimized TIFF files: tiles of 256 x 256, deflated, with
// smaller copies of the raster (overviews).
//
// All directories come before all tiles. So a reader that fetches the first kilobytes knows where
// every tile is. The file begins with GDAL's description of this layout. Each tile has its size
// before it and a copy of its last bytes after it, so that a reader needs no second request.
//
// Source    TIFF 6.0 (Adobe, 1992); "Cloud Optimized GeoTIFF" of GDAL's COG driver; OGC 19-008r4
//           (GeoTIFF 1.1) for the tags of georeferencing.
// Threads   Pure; tiles are packed on several threads, with the same bits for any number of
//           threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::render {

enum class TiffSamples {
    gray_float,  // one IEEE float
    palette,     // one byte, the number of a color
    rgba,        // four bytes; alpha is not premultiplied
};

struct TiffRaster {
    int width = 0, height = 0;
    std::vector<std::byte> pixels;  // row by row, from the top
};

// A key of GeoTIFF: a short number, a double or a text.
struct GeoKey {
    std::uint16_t id = 0;
    std::uint16_t number = 0;  // if the key is a short number
    bool is_double = false;
    double value = 0;
    std::string text = {};  // not empty if the key is a text
};

struct TiffFacts {
    TiffSamples samples = TiffSamples::gray_float;
    std::vector<std::array<std::uint8_t, 3>> palette = {};  // up to 256 colors
    std::array<double, 2> pixel_size = {};                  // in units of the map
    std::array<double, 2> top_left = {};  // the corner of the first pixel: east, north
    std::vector<GeoKey> geo_keys = {};    // in rising order
    std::string description = {}, software = {};
    std::string date_time = {};  // "2022:03:17 00:08:42"
    std::string gdal_metadata = {};
    std::string gdal_nodata = {};
};

// Writes a file. `rasters` are the whole raster and then its overviews, each half as large as the
// raster before. Errors: bad_argument for rasters without pixels, or with bytes that do not fit
// their size; unsupported for more than the 4 GiB that a TIFF can have; internal if zlib refuses.
[[nodiscard]] Result<std::vector<std::byte>> write_tiff(const std::vector<TiffRaster>& rasters,
                                                        const TiffFacts& facts, int threads);

inline constexpr int tiff_tile_side = 256;

}  // namespace stormcellar::render
