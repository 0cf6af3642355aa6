// stormcellar/render/color_table.h -- the look of values: their colors, and how opaque echo is.
//
// A table is a list of stops that rise in value. From one stop to the next the color goes from
// `color` to `until`. In a stepped table, which shows classes, the two colors are equal; in a
// smooth table they differ. Colors blend in sRGB, as drawn. A value below the first stop has no
// color. A value above the last stop has that stop's `color`. A class includes its lower bound.
//
// The alpha of a color counts in flat products (a composite over a map). In a volume, `extinction`
// says how opaque echo is: points of optical depth per kilometer of the drawn scene, with straight
// lines between them. The extinction is zero below the first point and constant above the last.
//
// Units     Values are in the unit of the moment; extinction is per kilometer or per meter, as
//           named.
// Threads   Plain data and pure functions.
// Errors    See validate().
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

struct ColorStop {
    float from = 0;
    Rgba8 color{};
    Rgba8 until{};
    bool operator==(const ColorStop&) const = default;
};

struct ExtinctionPoint {
    float value = 0;
    double per_km = 0;  // a path of 1 km has the opacity 1 - exp(-per_km)
    bool operator==(const ExtinctionPoint&) const = default;
};

struct ColorTable {
    std::string name;  // "nws-reflectivity"
    level2::Moment moment = level2::Moment::ref;
    std::string unit;              // "dBZ"; empty: no unit
    std::vector<ColorStop> stops;  // at least one
    float end = 0;                 // upper end of the last class in a color bar
    // Start of the color bar. If empty, the bar begins with the first class, which may reach far
    // down.
    std::optional<float> bar_begin;
    Rgba8 range_folded{};
    std::vector<ExtinctionPoint> extinction;  // at least one, values rise strictly

    [[nodiscard]] float lowest() const { return stops.front().from; }
    bool operator==(const ColorTable&) const = default;
};

// The largest number of stops in a table. The limit bounds the size of files; no display shows more
// colors.
inline constexpr std::size_t most_stops = 4096;

// Checks a table. Returns bad_argument unless there are 1 to most_stops stops that rise strictly,
// the ends of the bar enclose them, there are extinction points that rise strictly, all numbers are
// finite, and no extinction is negative.
[[nodiscard]] Status validate(const ColorTable& table);

// Returns true if no color blends, so that the table shows classes.
[[nodiscard]] bool is_stepped(const ColorTable& table);

// Returns the color of a value, or none for NaN and below the first stop.
[[nodiscard]] std::optional<Rgba8> color_of(const ColorTable& table, float value);
// Returns the extinction per meter of the drawn scene, times `opacity`; 0 for a value without a
// color.
[[nodiscard]] double extinction_per_m(const ColorTable& table, double value, double opacity);

// Returns the colors of the National Weather Service for reflectivity
// (render/color/built_in_tables.h).
[[nodiscard]] const ColorTable& nws_reflectivity();

}  // namespace stormcellar::render
