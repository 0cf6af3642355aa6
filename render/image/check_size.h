// render/image/check_size.h -- checks a picture before it is encoded in a format.
//
// Threads   Pure.
#pragma once

#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

// Checks that there is at least one pixel, that the bytes fit the size, and that no side exceeds
// the limit. Errors: bad_argument; the message calls the image `what`, which is "picture" or
// "frame".
[[nodiscard]] Status check_size(const Image& image, int largest_side, std::string_view what);

}  // namespace stormcellar::render
