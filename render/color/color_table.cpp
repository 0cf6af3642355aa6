#include "stormcellar/render/color_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/floating_point.h"
#include "render/image/level.h"

namespace stormcellar::render {
namespace {

std::uint8_t blend(std::uint8_t from, std::uint8_t to, double share) {
    return nearest_level(from + (to - from) * share);
}

}  // namespace

Status validate(const ColorTable& table) {
    const auto refuse = [](std::string_view why) {
        return fail(ErrorCode::bad_argument, "{}", why);
    };
    if (table.stops.empty()) return refuse("has no colors");
    if (table.stops.size() > most_stops) return refuse("has more than 4096 colors");
    if (table.extinction.empty()) return refuse("has no opacity");
    const auto follows = [](float before, float after) {
        return std::isfinite(after) && std::isgreater(after, before);
    };
    float before = -std::numeric_limits<float>::infinity();
    for (const ColorStop& stop : table.stops) {
        if (!follows(before, stop.from)) return refuse("has values that do not rise");
        before = stop.from;
    }
    if (!follows(before, table.end)) return refuse("ends before its last color");
    if (table.bar_begin && !is_within(*table.bar_begin, table.lowest(), table.end)) {
        return refuse("has a color bar that begins outside its values");
    }
    before = -std::numeric_limits<float>::infinity();
    for (const ExtinctionPoint& point : table.extinction) {
        if (!follows(before, point.value))
            return refuse("has opacities at values that do not rise");
        before = point.value;
        if (!is_within(point.per_km, 0.0, 1e6)) {
            return refuse("has an opacity per km that is not 0 to 1000000");
        }
    }
    return {};
}

bool is_stepped(const ColorTable& table) {
    return std::all_of(table.stops.begin(), table.stops.end(),
                       [](const ColorStop& stop) { return stop.color == stop.until; });
}

std::optional<Rgba8> color_of(const ColorTable& table, float value) {
    if (!std::isgreaterequal(value, table.lowest())) return std::nullopt;
    const auto after = std::upper_bound(table.stops.begin(), table.stops.end(), value,
                                        [](float v, const ColorStop& s) { return v < s.from; });
    const ColorStop& stop = *(after - 1);
    if (after == table.stops.end() || stop.color == stop.until) return stop.color;
    const double share = static_cast<double>(value - stop.from) / (after->from - stop.from);
    Rgba8 color{};
    for (std::size_t c = 0; c < color.size(); ++c)
        color[c] = blend(stop.color[c], stop.until[c], share);
    return color;
}

double extinction_per_m(const ColorTable& table, double value, double opacity) {
    const auto& points = table.extinction;
    const bool shown = std::isgreaterequal(value, static_cast<double>(table.lowest())) &&
                       value >= static_cast<double>(points.front().value);
    if (!shown) return 0;
    const auto after = std::upper_bound(
        points.begin(), points.end(), value,
        [](double v, const ExtinctionPoint& p) { return v < static_cast<double>(p.value); });
    const ExtinctionPoint& below = *(after - 1);
    if (after == points.end()) return opacity * below.per_km / 1000;
    const double share = (value - static_cast<double>(below.value)) /
                         static_cast<double>(after->value - below.value);
    return opacity * std::lerp(below.per_km, after->per_km, share) / 1000;
}

}  // namespace stormcellar::render
