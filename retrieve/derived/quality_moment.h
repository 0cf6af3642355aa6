// retrieve/derived/quality_moment.h -- the moment POW, probability of weather, and volumes without
// the echo that is probably no weather.
//
// POW has the gates and the flags of REF, and comes in steps of 0.004.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// Adds POW after each reflectivity moment. Does nothing to a volume without reflectivity.
void add_quality_moment(level2::Volume& volume);

// Makes gates below threshold, in all measured moments, if their probability of weather is less
// than `least`. A sweep without reflectivity takes the probabilities of the nearest sweep that has
// it. Gates whose probability is unknown stay. Returns the note for the provenance of grids, which
// gives `least` and the share of reflectivity gates with echo that were left out.
[[nodiscard]] std::string keep_weather(level2::Volume& volume, double least);

// Begins the note.
inline const std::string quality_words = "probability of weather at least ";

}  // namespace stormcellar::retrieve
