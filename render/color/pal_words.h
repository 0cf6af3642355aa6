// render/color/pal_words.h -- the names of products and units in .pal files, and their meaning.
//
// The viewer has a copy of these tables. tests/repository/viewer_facts_test.cpp compares the copy
// with these tables, and can write the copy.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "stormcellar/level2/moment.h"

namespace stormcellar::render {

// A product with its moment, or with its unit if it is not a moment. Readers also accept the names
// of moments.
struct PalProduct {
    std::string_view word = {};
    std::optional<level2::Moment> moment = std::nullopt;
    std::string_view unit = {};
};
inline constexpr auto pal_products = std::to_array<PalProduct>({
    {"BR", level2::Moment::ref},
    {"CR", level2::Moment::ref},
    {"BV", level2::Moment::vel},
    {"CC", level2::Moment::rho},
    {"ET", {}, "km"},
    {"EET", {}, "km"},
    {"VIL", {}, "kg/m2"},
    {"DVL", {}, "kg/m2"},
});

// A unit of .pal files, and the number of these units that make one of ours.
struct PalUnit {
    std::string_view word = {};
    double per_ours = 1;
    std::string_view ours = {};
};
inline constexpr auto pal_units = std::to_array<PalUnit>({
    {"KT", 1.943844, "m/s"},
    {"KTS", 1.943844, "m/s"},
    {"KNOTS", 1.943844, "m/s"},
    {"MPH", 2.236936, "m/s"},
    {"KMH", 3.6, "m/s"},
    {"KM/H", 3.6, "m/s"},
    {"M/S", 1, "m/s"},
    {"MPS", 1, "m/s"},
    {"KFT", 3.280840, "km"},
    {"FT", 3280.840, "km"},
    {"KM", 1, "km"},
    {"M", 1000, "km"},
    {"DBZ", 1, "dBZ"},
    {"DB", 1, "dB"},
    {"KG/M2", 1, "kg/m2"},
    {"%", 100, ""},
});

}  // namespace stormcellar::render
