#include "render/image/shades.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "render/image/level.h"

namespace stormcellar::render {

const Shades& shades_of(Theme theme) {
    switch (theme) {
        case Theme::light:
            return shades::light;
        case Theme::dark:
            break;
    }
    return shades::dark;
}

Rgba8 mixed_between(Rgba8 one, Rgba8 other, double share) {
    for (std::size_t c = 0; c < 3; ++c) {
        const double from = one[c];
        one[c] = nearest_level(from + share * (other[c] - from));
    }
    return one;
}

Rgba8 hatched(Rgba8 ground, Rgba8 lines, int x, int y, double scale) {
    const double period = 9 * scale;  // distance between two lines, along a row of pixels
    const double place = x + y;
    const double along = place - period * static_cast<int>(place / period);
    const double distance = std::min(along, period - along) / std::numbers::sqrt2;
    return mixed(ground, lines, std::clamp(0.5 * scale + 0.5 - distance, 0.0, 1.0));
}

}  // namespace stormcellar::render
