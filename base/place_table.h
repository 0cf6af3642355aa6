// base/place_table.h -- a table of towns, and the form in which their names are compared.
//
// The table has the incorporated places and the census-designated places of the United States and
// Puerto Rico, the towns of New England, the townships of New Jersey, and the cities of other
// countries that the map shows.
//
// Units     Degrees on WGS84. A position is the middle of a place's area, or a city's center.
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
// apostrophes, with single spaces in place of spaces and hyphens, and with "st" in place of "saint"
// as the first of several words.
[[nodiscard]] std::string compared_name(std::string_view name);

}  // namespace stormcellar
