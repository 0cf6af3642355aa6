// retrieve/derived/quality_moment.h -- the moment POW, probability of weather, and volumes without
// the echo that is probably not weather.
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

// The number of reflectivity gates with echo, and how many of them are left out.
struct LeftOutEcho {
    std::int64_t echo = 0, left_out = 0;
    std::array<std::int64_t, echo_kind_count> of_kind{};  // of the gates left out; 0 if unnamed

    LeftOutEcho& operator+=(const LeftOutEcho& other);
    // Returns the gates as a percentage of the echo; 0 without echo.
    [[nodiscard]] double percent(std::int64_t gates) const;
};

// Returns the note for the provenance of grids. It has `least`. If there is echo, it also has the
// share that is left out, and the two largest kinds (echo_kinds.h) if kinds are named.
[[nodiscard]] std::string weather_note(double least, const LeftOutEcho& left_out);

// Sets gates of all moments to below threshold if their probability of weather is less than
// `least`. A sweep without reflectivity takes the probabilities of the nearest sweep that has
// it. Gates whose probability is unknown stay.
LeftOutEcho keep_weather(level2::Volume& volume, double least);

// Does the same to one sweep of a growing volume. `others` are the sweeps that came before. Kinds
// get no names, because naming them takes longer than all other work, and a growing volume is
// judged many times.
LeftOutEcho keep_weather(level2::Sweep& sweep, std::span<const level2::Sweep> others, double least);

// The words with which the note begins.
inline const std::string quality_words = "probability of weather at least ";

}  // namespace stormcellar::retrieve
