// render/image/shades.h -- the quiet colors behind and around the echo.
//
// They are dark and nearly gray, so that none can be taken for a reflectivity.
#pragma once

#include "stormcellar/render/image.h"

namespace stormcellar::render::shades {

inline constexpr Rgba8 page = {11, 14, 19, 255};
inline constexpr Rgba8 seen = {32, 38, 47, 255};        // ground, seen from low down
inline constexpr Rgba8 seen_aloft = {22, 26, 33, 255};  // ground, seen only from higher up
inline constexpr Rgba8 not_seen = {16, 18, 22, 255};
inline constexpr Rgba8 hatch = {74, 78, 88, 255};    // the lines over not_seen
inline constexpr Rgba8 haze = {104, 110, 122, 255};  // for air that was not seen
inline constexpr Rgba8 border = {108, 120, 138, 255};
inline constexpr Rgba8 ring = {150, 165, 185, 120};
// The lines of the map: readable on echo over their casing, and too gray to be taken for echo.
inline constexpr Rgba8 county = {104, 112, 122, 150};
inline constexpr Rgba8 state = {150, 158, 170, 230};
inline constexpr Rgba8 country = {188, 192, 200, 240};
inline constexpr Rgba8 coast = {140, 160, 182, 235};
inline constexpr Rgba8 casing = {8, 10, 14, 90};
inline constexpr Rgba8 city = {206, 210, 216, 255};
inline constexpr Rgba8 separator = {40, 48, 60, 255};
inline constexpr Rgba8 text = {232, 236, 242, 255};
inline constexpr Rgba8 quiet_text = {160, 172, 188, 255};
inline constexpr Rgba8 warning_text = {255, 190, 90, 255};
inline constexpr Rgba8 halo = {8, 10, 14, 220};

// Returns the color of what was not seen at a pixel of the whole picture: not_seen under thin
// diagonal lines, at `scale` times the usual distance.
[[nodiscard]] Rgba8 hatched(int x, int y, double scale);

}  // namespace stormcellar::render::shades
