// retrieve/derived/quality_moment.h -- the moment POW, probability of weather, and volumes without
// the echo that is probably no weather.
//
// POW has the gates and the flags of REF, and comes in steps of 0.004.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// Adds POW after each reflectivity moment. Does nothing to a volume without reflectivity.
void add_quality_moment(level2::Volume& volume);

// The reflectivity gates with echo, and those of them that are left out.
struct LeftOutEcho {
    std::int64_t echo = 0, left_out = 0;

    LeftOutEcho& operator+=(const LeftOutEcho& other) {
        echo += other.echo;
        left_out += other.left_out;
        return *this;
    }
};

// Returns the note for the provenance of grids, which gives `least` and the share left out.
[[nodiscard]] std::string weather_note(double least, const LeftOutEcho& left_out);

// Makes gates below threshold, in all measured moments, if their probability of weather is less
// than `least`. A sweep without reflectivity takes the probabilities of the nearest sweep that has
// it. Gates whose probability is unknown stay.
LeftOutEcho keep_weather(level2::Volume& volume, double least);

// Does the same to one sweep of a volume, of which `others` have come.
LeftOutEcho keep_weather(level2::Sweep& sweep, std::span<const level2::Sweep> others, double least);

// Begins the note.
inline const std::string quality_words = "probability of weather at least ";

}  // namespace stormcellar::retrieve
