#include "render/image/shades.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace stormcellar::render::shades {

Rgba8 hatched(int x, int y, double scale) {
    const double period = 9 * scale;  // along a row of pixels
    const double along = std::fmod(static_cast<double>(x + y), period);
    const double distance = std::min(along, period - along) / std::numbers::sqrt2;
    const double line = std::clamp(0.5 * scale + 0.5 - distance, 0.0, 1.0);
    Rgba8 colour = not_seen;
    for (std::size_t c = 0; c < 3; ++c) {
        colour[c] = static_cast<std::uint8_t>(
            std::lround(not_seen[c] + line * (static_cast<double>(hatch[c]) - not_seen[c])));
    }
    return colour;
}

}  // namespace stormcellar::render::shades
