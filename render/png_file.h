// render/png_file.h -- an Image as PNG bytes.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "render/image.h"

namespace stormcellar::render {

// `texts` become tEXt chunks (keyword, Latin-1 text).
[[nodiscard]] Result<std::vector<std::byte>> encode_png(
    const Image& image, const std::vector<std::pair<std::string, std::string>>& texts = {});

}  // namespace stormcellar::render
