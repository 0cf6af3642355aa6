// render/colour/colour_bar.h -- a colour table as a bar: blocks of colour and the values beside
// them, as shares of the bar's length from its lower end.
//
// A stepped table of up to 24 classes has a block of one length for each, with its lower bound (not
// for a first class that reaches down far); other tables are in proportion to their values, with
// round values beside them. Thread contract: pure functions.
#pragma once

#include <string>
#include <vector>

#include "render/colour/colour_table.h"

namespace stormcellar::render {

struct BarBlock {
    double low = 0, high = 0;
    Rgba8 colour{};  // opaque: as it looks over plain ground
};
struct BarTick {
    double at = 0;
    std::string text;
};
struct ColourBar {
    std::vector<BarBlock> blocks;  // from the lower end to the upper, without gaps
    std::vector<BarTick> ticks;
};

// `most_ticks` at least 2.
[[nodiscard]] ColourBar colour_bar(const ColourTable& table, int most_ticks);

// 1, 2 or 5 times a power of ten: so that a range (above 0) has at most so many steps.
[[nodiscard]] double round_step(double range, int most_steps);

// A colour over an opaque one.
[[nodiscard]] Rgba8 over(const Rgba8& colour, const Rgba8& below);

}  // namespace stormcellar::render
