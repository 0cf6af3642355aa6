// stormcellar/render/units.h -- the units in which a picture writes speeds, distances and heights.
//
// They change texts, numbers of axes and legends, and the distances of range rings, never what is
// drawn, computed or stored: that is in meters, kilometers and meters per second everywhere.
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
    std::string_view symbol = {};  // in pictures; taken on the command line as well
    double si = 1;                 // one of it in meters, or in meters per second
    bool of_speed = false, of_distance = false, of_height = false;
};

[[nodiscard]] std::span<const UnitFacts> all_units();
[[nodiscard]] const UnitFacts& facts_of(Unit unit);

// Heights are those above sea level, and distances are along the ground.
struct Units {
    Unit speed = Unit::mps;
    Unit distance = Unit::km;
    Unit height = Unit::km;
};

// Reads "knots,miles,kft", in any order and case. A quantity without a name keeps its default unit.
// km applies to distances and heights, if no other name does. Errors: bad_argument for a name that
// is not known, with the nearest that is, and for two units of one quantity.
[[nodiscard]] Result<Units> units_from_names(std::string_view names);
// "m/s,km" or "knots,miles,kft", as units_from_names() reads them.
[[nodiscard]] std::string unit_names(const Units& units);
// "m/s, knots, mph or km/h for speeds; km, ... for distances; km, kft or ft for heights".
[[nodiscard]] std::string units_for_help();

// The unit in which a stored value is shown, and the factor to it.
struct ShownUnit {
    std::string symbol;     // "kt"; empty for a number without a unit
    double per_stored = 1;  // shown = stored * per_stored
};
// `stored` is the unit of a moment or a product: "m/s" is a speed, and "km" a height; others stay.
[[nodiscard]] ShownUnit shown_unit(std::string_view stored, const Units& units);

}  // namespace stormcellar::render
