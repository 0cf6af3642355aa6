#include "stormcellar/render/units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <vector>

#include "base/name_list.h"
#include "base/split.h"
#include "render/image/unknown_name.h"

namespace stormcellar::render {
namespace {

constexpr double foot_m = 0.3048;
constexpr double mile_m = 5280 * foot_m;
constexpr double nautical_mile_m = 1852;
constexpr double hour_s = 3600;

constexpr auto unit_facts = std::to_array<UnitFacts>({
    {.unit = Unit::mps, .name = "m/s", .symbol = "m/s", .si = 1, .of_speed = true},
    {.unit = Unit::knots,
     .name = "knots",
     .symbol = "kt",
     .si = nautical_mile_m / hour_s,
     .of_speed = true},
    {.unit = Unit::mph, .name = "mph", .symbol = "mph", .si = mile_m / hour_s, .of_speed = true},
    {.unit = Unit::kmh, .name = "km/h", .symbol = "km/h", .si = 1000 / hour_s, .of_speed = true},
    {.unit = Unit::km,
     .name = "km",
     .symbol = "km",
     .si = 1000,
     .of_distance = true,
     .of_height = true},
    {.unit = Unit::miles, .name = "miles", .symbol = "mi", .si = mile_m, .of_distance = true},
    {.unit = Unit::nautical_miles,
     .name = "nautical-miles",
     .symbol = "nmi",
     .si = nautical_mile_m,
     .of_distance = true},
    {.unit = Unit::kft, .name = "kft", .symbol = "kft", .si = 1000 * foot_m, .of_height = true},
    {.unit = Unit::feet, .name = "feet", .symbol = "ft", .si = foot_m, .of_height = true},
});
static_assert(is_in_order(unit_facts, &UnitFacts::unit));

// A quantity that a unit may measure.
struct Quantity {
    bool UnitFacts::*of = nullptr;
    Unit Units::*unit = nullptr;
    std::string_view name;
};
constexpr std::array quantities = {Quantity{&UnitFacts::of_speed, &Units::speed, "speeds"},
                                   Quantity{&UnitFacts::of_distance, &Units::distance, "distances"},
                                   Quantity{&UnitFacts::of_height, &Units::height, "heights"}};

bool is_of_several(const UnitFacts& facts) {
    return std::ranges::count_if(quantities, [&](const Quantity& q) { return facts.*q.of; }) > 1;
}

Result<const UnitFacts*> unit_named(std::string_view name) {
    std::string lower(name);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
    std::vector<std::string> names;
    for (const UnitFacts& facts : unit_facts) {
        if (lower == facts.name || lower == facts.symbol) return &facts;
        names.emplace_back(facts.name);
    }
    return unknown_name("unit", name, names, "units are " + units_for_help());
}

// The units that have been named so far, in the order of `quantities`.
using NamedUnits = std::array<const UnitFacts*, quantities.size()>;

// Takes the unit for each quantity that the unit measures, unless the quantity already has a unit.
// Errors: bad_argument if every such quantity already has a unit.
Status take(const UnitFacts& facts, NamedUnits& named) {
    bool is_used = false;
    const Quantity* taken = nullptr;
    for (std::size_t i = 0; i < quantities.size(); ++i) {
        if (!(facts.*quantities[i].of)) continue;
        if (named[i] == nullptr) {
            named[i] = &facts;
            is_used = true;
        } else if (taken == nullptr) {
            taken = &quantities[i];
        }
    }
    if (is_used || taken == nullptr) return {};
    const auto other = named[static_cast<std::size_t>(taken - quantities.data())];
    return fail(ErrorCode::bad_argument, "{} and {} are both units of {}; give one of them",
                other->name, facts.name, taken->name);
}

}  // namespace

std::span<const UnitFacts> all_units() {
    return unit_facts;
}

const UnitFacts& facts_of(Unit unit) {
    return unit_facts[static_cast<std::size_t>(unit)];
}

Result<Units> units_from_names(std::string_view names) {
    std::vector<const UnitFacts*> units;
    for (const std::string_view name : split(names, ',')) {
        const auto unit = unit_named(name);
        if (!unit) return pass_on(unit);
        units.push_back(*unit);
    }
    // Units of several quantities come last, and apply to the quantities that have no unit yet.
    std::stable_partition(units.begin(), units.end(),
                          [](const UnitFacts* f) { return !is_of_several(*f); });
    NamedUnits named{};
    for (const UnitFacts* facts : units) {
        if (Status fine = take(*facts, named); !fine) return pass_on(fine);
    }
    Units result;
    for (std::size_t i = 0; i < quantities.size(); ++i) {
        if (named[i] != nullptr) result.*quantities[i].unit = named[i]->unit;
    }
    return result;
}

std::string unit_names(const Units& units) {
    std::string names;
    for (const Quantity& quantity : quantities) {
        const std::string_view name = facts_of(units.*quantity.unit).name;
        // Name a unit of both distances and heights only once.
        if (!names.empty() && names.ends_with("," + std::string(name))) continue;
        if (!names.empty()) names += ",";
        names += name;
    }
    return names;
}

std::string units_for_help() {
    std::string text;
    for (const Quantity& quantity : quantities) {
        std::vector<UnitFacts> of_it;
        for (const UnitFacts& facts : unit_facts) {
            if (facts.*quantity.of) of_it.push_back(facts);
        }
        if (!text.empty()) text += "; ";
        text += names_in(of_it, ", ", " or ") + " for " + std::string(quantity.name);
    }
    return text;
}

ShownUnit shown_unit(std::string_view stored, const Units& units) {
    const auto in = [](Unit unit, double stored_si) {
        const UnitFacts& facts = facts_of(unit);
        return ShownUnit{std::string(facts.symbol), stored_si / facts.si};
    };
    if (stored == facts_of(Unit::mps).symbol) return in(units.speed, 1);
    if (stored == facts_of(Unit::km).symbol) return in(units.height, facts_of(Unit::km).si);
    return {std::string(stored), 1};
}

}  // namespace stormcellar::render
