// render/view/length_text.h -- writes numbers, values, lengths on the ground, heights and motions
// for labels.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "stormcellar/render/units.h"
#include "stormcellar/retrieve/storm_motion.h"

namespace stormcellar::render {

// Returns the number rounded to `digits` significant digits, without trailing zeros and never with
// an exponent: "9840".
[[nodiscard]] std::string number_text(double number, int digits = 6);

// Returns the stored value in the unit in which it is shown: "45.5 dBZ", or "0.98" if there is no
// unit.
[[nodiscard]] std::string value_text(float value, const ShownUnit& unit, int digits);

// Returns "50 km", "200 m" or "30 mi". A length that is not round in its unit has three digits.
[[nodiscard]] std::string distance_text(double metres, const Units& units);
// Returns "3 km", "9.84 kft" or "9840 ft".
[[nodiscard]] std::string height_text(double metres, const Units& units);

// Returns "motion from 240 degrees at 15 m/s", or with the speed in another unit: "29.2 kt".
[[nodiscard]] std::string motion_text(const retrieve::Motion& motion, const Units& units);

// Returns the round length whose ratio to `metres` (above 0) is nearest to 1. Round lengths are 1,
// 1.5, 2, 2.5, 3, 4, 5, 6 and 8 of the unit of distances, and as many tens, hundreds or tenths.
// Kilometers are not rounded.
[[nodiscard]] double round_distance(double metres, const Units& units);

// Returns the unit in which steps of heights are counted, in meters: 1 km or 1000 feet.
[[nodiscard]] double height_step_unit_m(const Units& units);

}  // namespace stormcellar::render
