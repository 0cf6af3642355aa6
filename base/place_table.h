// base/place_table.h -- finds towns by name.
//
// The table has the incorporated places and the census-designated places of the United States and
// Puerto Rico, the towns of New England and the townships of New Jersey, and the cities of the map
// elsewhere.
//
// Units     Degrees on WGS84, of the middle of a place's area or of a city's center.
// Threads   Any thread may call every function; the table is read at the first call.
// Accuracy  0.001 degrees as published, and a place is some kilometers wide.
// Source    docs/data-sources.md.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace stormcellar {

struct NamedPlace {
    std::string_view name;    // "Moore"
    std::string_view region;  // "OK", or a country
    double latitude_deg = 0;
    double longitude_deg = 0;
    int population_thousands = 0;  // 0: unknown
};

[[nodiscard]] std::span<const NamedPlace> all_places();  // by name

// Returns the name in the form for comparisons: in lower case, without accents, dots and
// apostrophes, with single spaces for spaces and hyphens, and "st" for "saint".
[[nodiscard]] std::string compared_name(std::string_view name);

}  // namespace stormcellar
