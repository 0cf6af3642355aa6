// stormcellar/render/png_file.h -- encodes an Image as PNG.
//
// Threads   Pure functions.
// Errors    See each function.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

enum class PngAlpha { when_needed, always };

// Returns the bytes of a PNG file in sRGB with 8 bits for each channel. The file is RGB if every
// pixel is opaque and `alpha` is when_needed, else RGBA. `texts` become tEXt chunks, with a keyword
// of 1 to 79 characters and a text in Latin-1. Errors: bad_argument for an image without pixels, an
// image whose bytes do not fit its size, a keyword of another length, or a zero byte in a keyword
// or text; internal if libpng refuses.
[[nodiscard]] Result<std::vector<std::byte>> encode_png(
    const Image& image, const std::vector<std::pair<std::string, std::string>>& texts = {},
    PngAlpha alpha = PngAlpha::when_needed);

// Encodes a picture of few colors, such as a map tile, as a smaller file and in less time than
// encode_png(). An image of up to 256 colors gets a palette (8 bits or fewer for a pixel); any
// other image becomes RGBA. Errors: those of encode_png().
[[nodiscard]] Result<std::vector<std::byte>> encode_png_of_few_colors(const Image& image);

}  // namespace stormcellar::render
