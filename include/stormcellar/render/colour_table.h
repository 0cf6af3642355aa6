// stormcellar/render/colour_table.h -- what values look like: colours, and how opaque echo is.
//
// A table is a list of stops that rise in value. From one stop to the next the colour goes from
// `colour` to `until`: one colour in a stepped table, which shows classes; a blend in a smooth one.
// Colours blend in sRGB, as drawn. A value below the first stop has no colour, one above the last
// has the last stop's first colour. A class holds its lower bound.
//
// Alpha of a colour counts in flat products (a composite over a map). How opaque echo is in a
// volume is `extinction`: points of optical depth per kilometre of the drawn scene, straight
// between two points; none below the first, the last one's above the last.
// Thread contract: plain data; functions are pure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

struct ColourStop {
    float from = 0;
    Rgba8 colour{};
    Rgba8 until{};
    bool operator==(const ColourStop&) const = default;
};

struct ExtinctionPoint {
    float value = 0;
    double per_km = 0;  // a path of 1 km has the opacity 1 - exp(-per_km)
    bool operator==(const ExtinctionPoint&) const = default;
};

struct ColourTable {
    std::string name;  // "nws-reflectivity"
    level2::Moment moment = level2::Moment::ref;
    std::string unit;               // "dBZ"; empty: a number without one
    std::vector<ColourStop> stops;  // at least one
    float end = 0;  // where the last class ends in a colour bar; above the last stop
    // Where a colour bar begins, if not with the first class, which reaches down far.
    std::optional<float> bar_begin;
    Rgba8 range_folded{};
    std::vector<ExtinctionPoint> extinction;  // at least one, values rise strictly

    [[nodiscard]] float lowest() const { return stops.front().from; }
    bool operator==(const ColourTable&) const = default;
};

// More than any display shows apart; bounds what files may ask for.
inline constexpr std::size_t most_stops = 4096;

// bad_argument, in words that follow the name of a table, unless there are 1 to most_stops stops
// that rise strictly, the bar's ends lie about them, there is an extinction of values that rise
// strictly, and all numbers are finite and no extinction is negative.
[[nodiscard]] Status validate(const ColourTable& table);

// Whether no colour blends: the table shows classes.
[[nodiscard]] bool is_stepped(const ColourTable& table);

// None below the first stop and for NaN.
[[nodiscard]] std::optional<Rgba8> colour_of(const ColourTable& table, float value);
// Per metre of the drawn scene, times `opacity`; 0 for what has no colour.
[[nodiscard]] double extinction_per_m(const ColourTable& table, double value, double opacity);

// The colours of the National Weather Service for reflectivity (render/colour/built_in_tables.h).
[[nodiscard]] const ColourTable& nws_reflectivity();

}  // namespace stormcellar::render
