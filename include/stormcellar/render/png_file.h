// stormcellar/render/png_file.h -- encodes an Image as PNG.
//
// Threads   A pure function.
// Errors    See encode_png().
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

enum class PngAlpha { when_needed, always };

// Returns the bytes of a PNG file with 8 bits in sRGB. It is RGB if every pixel is opaque and alpha
// is only kept when needed, else RGBA. `texts` become tEXt chunks: a keyword of 1 to 79 characters
// and a text in Latin-1. Errors: bad_argument for an image whose bytes do not fit its size, or a
// text with a zero byte.
[[nodiscard]] Result<std::vector<std::byte>> encode_png(
    const Image& image, const std::vector<std::pair<std::string, std::string>>& texts = {},
    PngAlpha alpha = PngAlpha::when_needed);

}  // namespace stormcellar::render
