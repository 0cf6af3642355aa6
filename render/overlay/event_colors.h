// render/overlay/event_colors.h -- the colors of events in the map of hazards of the National
// Weather Service. viewer/src/facts.ts has a copy.
#pragma once

#include <array>
#include <string_view>

#include "stormcellar/render/image.h"

namespace stormcellar::render {

struct EventColor {
    std::string_view event;
    Rgba8 color;
};

inline constexpr std::array<EventColor, 10> event_colors = {{
    {"Tornado Warning", {255, 0, 0, 255}},
    {"Severe Thunderstorm Warning", {255, 165, 0, 255}},
    {"Flash Flood Warning", {139, 0, 0, 255}},
    {"Special Marine Warning", {255, 165, 0, 255}},
    {"Snow Squall Warning", {199, 21, 133, 255}},
    {"Flood Warning", {0, 255, 0, 255}},
    {"Flood Advisory", {0, 255, 127, 255}},
    {"Special Weather Statement", {255, 228, 181, 255}},
    {"Tornado Watch", {255, 255, 0, 255}},
    {"Severe Thunderstorm Watch", {219, 112, 147, 255}},
}};

}  // namespace stormcellar::render
