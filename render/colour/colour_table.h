// render/colour/colour_table.h -- what values look like: colours, and how opaque echo is.
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

#include <optional>
#include <string>
#include <vector>

#include "level2/volume.h"
#include "render/image.h"

namespace stormcellar::render {

struct ColourStop {
    float from = 0;
    Rgba8 colour{};
    Rgba8 until{};
};

struct ExtinctionPoint {
    float value = 0;
    double per_km = 0;  // a path of 1 km has the opacity 1 - exp(-per_km)
};

struct ColourTable {
    std::string name;  // "nws-reflectivity"
    level2::Moment moment = level2::Moment::ref;
    std::string unit;               // "dBZ"; empty: a number without one
    std::vector<ColourStop> stops;  // at least one
    float end = 0;  // where the last class ends in a colour bar; above the last stop
    Rgba8 range_folded{};
    std::vector<ExtinctionPoint> extinction;  // at least one, values rise strictly

    [[nodiscard]] float lowest() const { return stops.front().from; }
};

// None below the first stop and for NaN.
[[nodiscard]] std::optional<Rgba8> colour_of(const ColourTable& table, float value);
// Per metre of the drawn scene, times `opacity`; 0 for what has no colour.
[[nodiscard]] double extinction_per_m(const ColourTable& table, double value, double opacity);

// The colours of the National Weather Service for reflectivity: 15 classes of 5 dB, from 5 dBZ; the
// last is open above. Range folded 77007d. Source: the WSR-88D products' standard colours.
// Extinction is the sum of a haze, which keeps weak echo in sight, and of a steep part, which makes
// cores solid: 0.012 * 10^((v - 5 dBZ) / 40 dB) + 0.12 * 10^((v - 50 dBZ) / 10 dB) per km, given at
// every decibel.
[[nodiscard]] const ColourTable& nws_reflectivity();

}  // namespace stormcellar::render
