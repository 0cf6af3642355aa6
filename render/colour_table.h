// render/colour_table.h -- the colours of the National Weather Service for reflectivity.
//
// 15 classes of 5 dB, from 5 dBZ; the last is open above. A class holds its lower bound.
// Source: the standard reflectivity colours of the WSR-88D products; range folded 77007d.
#pragma once

#include <array>
#include <optional>

#include "render/image.h"

namespace stormcellar::render {

struct ColourClass {
    float from_dbz;
    Rgba8 colour;
};

inline constexpr std::array<ColourClass, 15> nws_reflectivity = {{
    {5, {0x04, 0xE9, 0xE7, 255}},
    {10, {0x01, 0x9F, 0xF4, 255}},
    {15, {0x03, 0x00, 0xF4, 255}},
    {20, {0x02, 0xFD, 0x02, 255}},
    {25, {0x01, 0xC5, 0x01, 255}},
    {30, {0x00, 0x8E, 0x00, 255}},
    {35, {0xFD, 0xF8, 0x02, 255}},
    {40, {0xE5, 0xBC, 0x00, 255}},
    {45, {0xFD, 0x95, 0x00, 255}},
    {50, {0xFD, 0x00, 0x00, 255}},
    {55, {0xD4, 0x00, 0x00, 255}},
    {60, {0xBC, 0x00, 0x00, 255}},
    {65, {0xF8, 0x00, 0xFD, 255}},
    {70, {0x98, 0x54, 0xC6, 255}},
    {75, {0xFD, 0xFD, 0xFD, 255}},
}};
inline constexpr float lowest_class_dbz = 5;
inline constexpr float class_width_dbz = 5;
inline constexpr Rgba8 range_folded_colour = {0x77, 0x00, 0x7D, 255};

// The colour of a value; none below the lowest class and for NaN.
[[nodiscard]] std::optional<Rgba8> nws_reflectivity_colour(float dbz);

}  // namespace stormcellar::render
