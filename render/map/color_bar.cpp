#include "render/map/color_bar.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "render/image/round_step.h"

namespace stormcellar::render {
namespace {

void add_block(ColorBar& bar, const Rect& box, double low_y, double high_y, Rgba8 color) {
    if (low_y <= high_y) return;
    if (!bar.blocks.empty() && bar.blocks.back().color == color) {
        Rect& last = bar.blocks.back().box;
        last = {last.x, high_y, last.width, last.bottom() - high_y};
        return;
    }
    bar.blocks.push_back({{box.x, high_y, box.width, low_y - high_y}, color});
}

// Returns the text for the bound of a class. In the unit of the table, bounds are round numbers. In
// another unit, they are rounded to whole numbers from 10 on, and to tenths below.
std::string bound_text(double value, const BarScale& scale) {
    const double shown = value * scale.shown_per_value;
    if (scale.shown_per_value == 1) return fmt::format("{:g}", shown);
    const double parts = std::abs(shown) < 9.95 ? 10 : 1;
    return fmt::format("{:g}", std::round(shown * parts) / parts + 0.0);
}

ColorBar stepped_bar(const BarScale& scale, const Rect& box, double least_tick, Rgba8 ground) {
    const ColorTable& table = scale.table;
    ColorBar bar;
    const std::size_t classes = table.stops.size();
    const double height = box.height / static_cast<double>(classes);
    std::size_t every = 1;
    while (static_cast<double>(every) * height < least_tick && every < classes)
        ++every;
    for (std::size_t i = 0; i < classes; ++i) {
        const double low = std::round(box.bottom() - static_cast<double>(i) * height);
        const double high = std::round(box.bottom() - static_cast<double>(i + 1) * height);
        if (low > high) {
            // Keep neighboring classes of the same color separate, so that each class is shown.
            bar.blocks.push_back(
                {{box.x, high, box.width, low - high}, over(table.stops[i].color, ground)});
        }
        const bool reaches_far = i == 0 && table.bar_begin;
        if (i % every == 0 && !reaches_far)
            bar.ticks.push_back({low, bound_text(static_cast<double>(table.stops[i].from), scale)});
    }
    return bar;
}

ColorBar smooth_bar(const BarScale& scale, const Rect& box, double least_tick, Rgba8 ground) {
    const ColorTable& table = scale.table;
    ColorBar bar;
    const double lowest = static_cast<double>(table.bar_begin.value_or(table.lowest()));
    const double span = std::max(1e-6, static_cast<double>(table.end) - lowest);
    const double top = std::round(box.y);
    const double bottom = std::round(box.bottom());
    const int rows = static_cast<int>(bottom - top);
    for (int row = 0; row < rows; ++row) {
        const double value = lowest + span * (row + 0.5) / rows;
        const auto color = color_of(table, static_cast<float>(value));
        add_block(bar, box, bottom - row, bottom - row - 1,
                  over(color.value_or(table.stops.front().color), ground));
    }
    const double step =
        round_step(span * scale.shown_per_value,
                   std::max(1, static_cast<int>(box.height / std::max(1.0, least_tick))));
    const auto first = static_cast<int>(std::ceil(lowest * scale.shown_per_value / step - 1e-6));
    const auto last =
        static_cast<int>(std::floor((lowest + span) * scale.shown_per_value / step + 1e-6));
    for (int i = first; i <= last; ++i) {
        const double shown = i * step;
        const double value = shown / scale.shown_per_value;
        bar.ticks.push_back({bottom - (value - lowest) / span * rows, fmt::format("{:g}", shown)});
    }
    return bar;
}

}  // namespace

ColorBar color_bar(const BarScale& scale, const Rect& box, double least_tick, Rgba8 ground) {
    return is_stepped(scale.table) ? stepped_bar(scale, box, least_tick, ground)
                                   : smooth_bar(scale, box, least_tick, ground);
}

ColorBar lying_bar(const BarScale& scale, const Rect& box,
                   const std::function<double(const std::string&)>& width_of, double gap,
                   Rgba8 ground) {
    // Makes an upright bar and turns it on its side. Takes away numbers until no number touches the
    // next.
    const Rect upright = {0, 0, box.height, box.width};
    const auto crowded = [&](const std::vector<BarTick>& ticks) {
        for (std::size_t i = 1; i < ticks.size(); ++i) {
            const double apart = std::abs(ticks[i].at - ticks[i - 1].at);
            if (apart < (width_of(ticks[i].text) + width_of(ticks[i - 1].text)) / 2 + gap)
                return true;
        }
        return false;
    };
    double least_tick = gap;
    ColorBar bar = color_bar(scale, upright, least_tick, ground);
    while (crowded(bar.ticks) && least_tick < 2 * box.width) {
        least_tick *= 1.25;
        bar = color_bar(scale, upright, least_tick, ground);
    }
    for (BarBlock& block : bar.blocks) {
        block.box = {box.x + box.width - block.box.bottom(), box.y, block.box.height, box.height};
    }
    for (BarTick& tick : bar.ticks)
        tick.at = box.x + box.width - tick.at;
    return bar;
}

}  // namespace stormcellar::render
