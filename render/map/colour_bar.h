// render/map/colour_bar.h -- how a colour table is shown as an upright bar.
#pragma once

#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "stormcellar/render/colour_table.h"

namespace stormcellar::render {

struct BarBlock {
    Rect box;  // whole pixels, so that no seam shows
    Rgba8 colour{};
};

struct BarTick {
    double y = 0;
    std::string text;
};

struct ColourBar {
    std::vector<BarBlock> blocks;  // from the bottom up; together they fill the box
    std::vector<BarTick> ticks;    // at least `least_tick` apart
};

// Rises with value. Stepped tables: classes of one height, ticks at lower bounds (every second,
// third... where there is no room). Tables with blends: regular in value from the first stop to
// `end`, ticks at round values. A box lower than a pixel a class loses classes, not its ends.
[[nodiscard]] ColourBar colour_bar(const ColourTable& table, const Rect& box, double least_tick);

}  // namespace stormcellar::render
