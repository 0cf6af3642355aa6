#include "render/colour/colour_bar.h"

#include <algorithm>
#include <cmath>

#include "render/shades.h"

namespace stormcellar::render {
namespace {

constexpr std::size_t most_classes = 24;
constexpr int smooth_blocks = 96;

ColourBar bar_of_classes(const ColourTable& table, int most_ticks) {
    ColourBar bar;
    const std::size_t classes = table.stops.size();
    const auto share = [&](std::size_t i) {
        return static_cast<double>(i) / static_cast<double>(classes);
    };
    const auto room = static_cast<std::size_t>(most_ticks);
    const std::size_t every = (classes + room - 1) / room;
    for (std::size_t i = 0; i < classes; ++i) {
        bar.blocks.push_back({share(i), share(i + 1), over(table.stops[i].colour, shades::seen)});
        const bool reaches_far = i == 0 && table.bar_begin;
        if (i % every == 0 && !reaches_far) {
            bar.ticks.push_back({share(i), fmt::format("{:g}", table.stops[i].from)});
        }
    }
    return bar;
}

}  // namespace

Rgba8 over(const Rgba8& colour, const Rgba8& below) {
    Rgba8 mixed = below;
    const double alpha = colour[3] / 255.0;
    for (std::size_t c = 0; c < 3; ++c) {
        mixed[c] = static_cast<std::uint8_t>(
            std::lround(below[c] + alpha * (static_cast<double>(colour[c]) - below[c])));
    }
    return mixed;
}

double round_step(double range, int most_steps) {
    const double least = range / most_steps;
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least * (1 - 1e-9)) return factor * power;
    }
    return 10 * power;
}

ColourBar colour_bar(const ColourTable& table, int most_ticks) {
    if (is_stepped(table) && table.stops.size() <= most_classes) {
        return bar_of_classes(table, most_ticks);
    }
    ColourBar bar;
    const double low = static_cast<double>(table.bar_begin.value_or(table.lowest()));
    const double range = static_cast<double>(table.end) - low;
    for (int i = 0; i < smooth_blocks; ++i) {
        const double middle = low + range * (i + 0.5) / smooth_blocks;
        const auto colour = colour_of(table, static_cast<float>(middle)).value_or(Rgba8{});
        bar.blocks.push_back({static_cast<double>(i) / smooth_blocks, (i + 1.0) / smooth_blocks,
                              over(colour, shades::seen)});
    }
    const double step = round_step(range, std::max(1, most_ticks - 1));
    const auto first = static_cast<long>(std::ceil(low / step - 1e-9));
    const auto last = static_cast<long>(std::floor((low + range) / step + 1e-9));
    for (long i = first; i <= last; ++i) {
        const double at = static_cast<double>(i) * step;
        bar.ticks.push_back({(at - low) / range, fmt::format("{:.6g}", at)});
    }
    return bar;
}

}  // namespace stormcellar::render
