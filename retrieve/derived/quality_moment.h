// retrieve/derived/quality_moment.h -- the moment POW, probability of weather, and volumes without
// the echo that is probably no weather.
//
// POW has the gates and the flags of REF, and comes in steps of 0.004.
//
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/echo_kinds.h"

namespace stormcellar::retrieve {

// Adds POW after each reflectivity moment. Does nothing to a volume without reflectivity.
void add_quality_moment(level2::Volume& volume);

// The reflectivity gates with echo, and those of them that are left out.
struct LeftOutEcho {
    std::int64_t echo = 0, left_out = 0;
    std::array<std::int64_t, echo_kind_count> of_kind{};  // of those left out; 0 without names

    LeftOutEcho& operator+=(const LeftOutEcho& other);
    // Returns the share of the echo.
    [[nodiscard]] double percent(std::int64_t gates) const;
};

// Returns the note for the provenance of grids: `least` and, if there is reflectivity, the share
// left out and, if they were named, the two largest kinds of it with their shares (echo_kinds.h).
[[nodiscard]] std::string weather_note(double least, const LeftOutEcho& left_out);

// Makes gates below threshold, in all measured moments, if their probability of weather is less
// than `least`. A sweep without reflectivity takes the probabilities of the nearest sweep that has
// it. Gates whose probability is unknown stay.
LeftOutEcho keep_weather(level2::Volume& volume, double least);

// Does the same to one sweep of a volume, of which `others` have come. Kinds get no names, because
// naming them takes longer than all the rest, and a growing volume is judged many times.
LeftOutEcho keep_weather(level2::Sweep& sweep, std::span<const level2::Sweep> others, double least);

// Begins the note.
inline const std::string quality_words = "probability of weather at least ";

}  // namespace stormcellar::retrieve
