// render/image/level.h -- rounds a level of a channel to a byte.
//
// Threads   A pure function.
#pragma once

#include <cstdint>

namespace stormcellar::render {

// Returns std::lround(level) for a level from 0 to 255. Millions of pixels need this, and the
// library's function takes ten times as long.
[[nodiscard]] inline std::uint8_t nearest_level(double level) {
    const int whole = static_cast<int>(level);
    return static_cast<std::uint8_t>(whole + (level - whole >= 0.5 ? 1 : 0));
}

}  // namespace stormcellar::render
