#include "stormcellar/render/image.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::render {
namespace {

std::size_t pixel_offset(const Image& image, int x, int y) {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
            static_cast<std::size_t>(x)) *
           4;
}

}  // namespace

Rgba8 over(const Rgba8& colour, const Rgba8& below) {
    Rgba8 mixed = below;
    const double alpha = colour[3] / 255.0;
    for (std::size_t c = 0; c < 3; ++c) {
        mixed[c] = static_cast<std::uint8_t>(
            std::lround(below[c] + alpha * (static_cast<double>(colour[c]) - below[c])));
    }
    return mixed;
}

Image::Image(int w, int h, Rgba8 fill)
    : width(w), height(h), rgba(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4) {
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        std::copy(fill.begin(), fill.end(), rgba.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

Rgba8 Image::at(int x, int y) const {
    const std::size_t at = pixel_offset(*this, x, y);
    return {rgba[at], rgba[at + 1], rgba[at + 2], rgba[at + 3]};
}

void Image::set(int x, int y, Rgba8 colour) {
    std::copy(colour.begin(), colour.end(),
              rgba.begin() + static_cast<std::ptrdiff_t>(pixel_offset(*this, x, y)));
}

}  // namespace stormcellar::render
