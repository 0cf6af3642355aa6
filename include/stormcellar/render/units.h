// stormcellar/render/units.h -- the units in which a picture writes speeds, distances and heights.
//
// Units change texts, numbers of axes and legends, and the distances of range rings. Drawing,
// computing and storage always use meters, kilometers and meters per second.
//
// Threads   Pure functions; the table is constant.
// Errors    See units_from_names().
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"

namespace stormcellar::render {

enum class Unit { mps, knots, mph, kmh, km, miles, nautical_miles, kft, feet };

struct UnitFacts {
    Unit unit = Unit::km;
    std::string_view name = {};    // on the command line and in scene files
    std::string_view symbol = {};  // in pictures, and also accepted on the command line
    double si = 1;                 // this unit in meters, or in meters per second
    bool of_speed = false, of_distance = false, of_height = false;
};

[[nodiscard]] std::span<const UnitFacts> all_units();
[[nodiscard]] const UnitFacts& facts_of(Unit unit);

// Heights are above sea level, and distances are along the ground.
struct Units {
    Unit speed = Unit::mps;
    Unit distance = Unit::km;
    Unit height = Unit::km;
};

// Reads "knots,miles,kft", in any order and case. A quantity whose unit is not named keeps its
// default unit. km is the unit of both distances and heights, unless another unit is named for one
// of them. Errors: bad_argument for an unknown name (the message gives the nearest known name or
// lists all names) and for two units of one quantity.
[[nodiscard]] Result<Units> units_from_names(std::string_view names);
// Returns "m/s,km" or "knots,miles,kft", in the form that units_from_names() reads.
[[nodiscard]] std::string unit_names(const Units& units);
// Returns "m/s, knots, mph or km/h for speeds; km, ... for distances; km, kft or ft for heights".
[[nodiscard]] std::string units_for_help();

// The unit in which a stored value is shown, and the factor from stored to shown values.
struct ShownUnit {
    std::string symbol;     // "kt"; empty for a number without a unit
    double per_stored = 1;  // shown = stored * per_stored
};
// Returns the unit that shows a value stored in the unit of a moment or a product. "m/s" is a
// speed, and "km" a height; other units do not change.
[[nodiscard]] ShownUnit shown_unit(std::string_view stored, const Units& units);

}  // namespace stormcellar::render
