#include "stormcellar/render/image.h"

#include <bit>
#include <cstring>

#include "render/image/check_size.h"
#include "render/image/level.h"

namespace stormcellar::render {

Rgba8 over(const Rgba8& color, const Rgba8& below) {
    if (color[3] == 255) return {color[0], color[1], color[2], below[3]};
    Rgba8 mixed = below;
    const double alpha = color[3] / 255.0;
    for (std::size_t c = 0; c < 3; ++c) {
        mixed[c] = nearest_level(below[c] + alpha * (static_cast<double>(color[c]) - below[c]));
    }
    return mixed;
}

Image::Image(int w, int h, Rgba8 fill)
    : width(w), height(h), rgba(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4) {
    const auto pixel = std::bit_cast<std::uint32_t>(fill);
    for (std::size_t i = 0; i < rgba.size(); i += sizeof pixel)
        std::memcpy(rgba.data() + i, &pixel, sizeof pixel);
}

Status check_size(const Image& image, int largest_side, std::string_view what) {
    const auto pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (image.width < 1 || image.height < 1 || image.rgba.size() != pixels * 4) {
        return fail(ErrorCode::bad_argument, "a {} of {} by {} pixels cannot have {} bytes", what,
                    image.width, image.height, image.rgba.size());
    }
    if (image.width > largest_side || image.height > largest_side) {
        return fail(ErrorCode::bad_argument,
                    "a {} of {} by {} pixels is too large; this format allows {} along a side",
                    what, image.width, image.height, largest_side);
    }
    return {};
}

}  // namespace stormcellar::render
