// stormcellar/render/png_file.h -- an Image as PNG bytes.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

enum class PngAlpha { when_needed, always };

// 8 bits, sRGB; RGB when every pixel is opaque and alpha is not always wanted, else RGBA. `texts`
// become tEXt chunks (keyword of 1 to 79 characters, Latin-1 text). bad_argument for an image whose
// bytes do not fit its size, or a text with a zero byte.
[[nodiscard]] Result<std::vector<std::byte>> encode_png(
    const Image& image, const std::vector<std::pair<std::string, std::string>>& texts = {},
    PngAlpha alpha = PngAlpha::when_needed);

}  // namespace stormcellar::render
