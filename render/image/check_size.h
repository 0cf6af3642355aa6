// render/image/check_size.h -- checks a picture before a format takes it.
//
// Threads   Pure.
#pragma once

#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

// Checks that there is a pixel, that the bytes fit the size, and that no side exceeds the limit.
// `what` is "picture" or "frame" in the error, which is bad_argument.
[[nodiscard]] Status check_size(const Image& image, int largest_side, std::string_view what);

}  // namespace stormcellar::render
