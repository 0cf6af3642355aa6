// render/map/color_bar.h -- shows a color table as a bar, upright or horizontal.
//
// Threads   Plain values and a pure function.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "stormcellar/render/color_table.h"

namespace stormcellar::render {

struct BarBlock {
    Rect box;  // whole pixels, so that there are no seams
    Rgba8 color{};
};

struct BarTick {
    double at = 0;  // y in an upright bar, x in a horizontal one
    std::string text;
};

struct ColorBar {
    std::vector<BarBlock> blocks;  // from the bottom up; together they fill the box
    std::vector<BarTick> ticks;    // at least `least_tick` apart
};

// A color table, and the factor by which its values are multiplied for the numbers of the bar.
struct BarScale {
    const ColorTable& table;
    double shown_per_value = 1;
};

// Makes a bar that rises with the value. In a stepped table, all classes have the same height, with
// ticks at their lower bounds (at every second, third ... if there is little room). In a table with
// blends, the bar is linear in the value from `bar_begin` (by default the first stop) to `end`,
// with ticks at round values. If a box has fewer pixels than classes, some classes are lost, but
// not those at the ends. Translucent colors show the color `ground` below them.
[[nodiscard]] ColorBar color_bar(const BarScale& scale, const Rect& box, double least_tick,
                                 Rgba8 ground);
// Makes a horizontal bar by the rules of color_bar(). It rises to the right. Its numbers are at
// least `gap` apart; `width_of` returns the width of a number.
[[nodiscard]] ColorBar lying_bar(const BarScale& scale, const Rect& box,
                                 const std::function<double(const std::string&)>& width_of,
                                 double gap, Rgba8 ground);

}  // namespace stormcellar::render
