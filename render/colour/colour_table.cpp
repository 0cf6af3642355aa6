#include "render/colour/colour_table.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::render {
namespace {

std::uint8_t blend(std::uint8_t from, std::uint8_t to, double share) {
    return static_cast<std::uint8_t>(std::lround(from + (to - from) * share));
}

double reflectivity_extinction(double dbz) {
    const double haze = 0.012 * std::pow(10.0, (dbz - 5) / 40);
    const double core = 0.12 * std::pow(10.0, (dbz - 50) / 10);
    return haze + core;
}

ColourTable make_nws_reflectivity() {
    constexpr float class_width = 5;
    constexpr Rgba8 classes[] = {
        {0x04, 0xE9, 0xE7, 255}, {0x01, 0x9F, 0xF4, 255}, {0x03, 0x00, 0xF4, 255},
        {0x02, 0xFD, 0x02, 255}, {0x01, 0xC5, 0x01, 255}, {0x00, 0x8E, 0x00, 255},
        {0xFD, 0xF8, 0x02, 255}, {0xE5, 0xBC, 0x00, 255}, {0xFD, 0x95, 0x00, 255},
        {0xFD, 0x00, 0x00, 255}, {0xD4, 0x00, 0x00, 255}, {0xBC, 0x00, 0x00, 255},
        {0xF8, 0x00, 0xFD, 255}, {0x98, 0x54, 0xC6, 255}, {0xFD, 0xFD, 0xFD, 255},
    };
    ColourTable table;
    table.name = "nws-reflectivity";
    table.unit = "dBZ";
    table.end = class_width;
    for (const Rgba8& colour : classes) {
        table.stops.push_back({table.end, colour, colour});
        table.end += class_width;
    }
    table.range_folded = {0x77, 0x00, 0x7D, 255};
    for (int dbz = 5; dbz <= 80; ++dbz)
        table.extinction.push_back({static_cast<float>(dbz), reflectivity_extinction(dbz)});
    return table;
}

}  // namespace

std::optional<Rgba8> colour_of(const ColourTable& table, float value) {
    if (!std::isgreaterequal(value, table.lowest())) return std::nullopt;
    const auto after = std::upper_bound(table.stops.begin(), table.stops.end(), value,
                                        [](float v, const ColourStop& s) { return v < s.from; });
    const ColourStop& stop = *(after - 1);
    if (after == table.stops.end() || stop.colour == stop.until) return stop.colour;
    const double share = static_cast<double>(value - stop.from) / (after->from - stop.from);
    Rgba8 colour{};
    for (std::size_t c = 0; c < colour.size(); ++c)
        colour[c] = blend(stop.colour[c], stop.until[c], share);
    return colour;
}

double extinction_per_m(const ColourTable& table, double value, double opacity) {
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

const ColourTable& nws_reflectivity() {
    static const ColourTable table = make_nws_reflectivity();
    return table;
}

}  // namespace stormcellar::render
