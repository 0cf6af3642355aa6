#include "stormcellar/accuracy/budget.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/printable.h"

namespace stormcellar::accuracy {
namespace {

constexpr std::string_view examples =
    "write, for example, \"250 m, 0.5 dB\", \"dE 2\" or \"20 ms\"";

enum class Slot { position, value, image, time };

struct UnitName {
    std::string_view name;  // in lower case
    Slot slot;
    double multiply;
    double divide;  // divisor: 20 / 1000 is exactly the double nearest to 0.02 s
    ValueUnit value_unit = ValueUnit::db;  // unit of the value that the number bounds
};
constexpr std::array unit_names = {UnitName{"m", Slot::position, 1, 1},
                                   UnitName{"km", Slot::position, 1000, 1},
                                   UnitName{"db", Slot::value, 1, 1, ValueUnit::db},
                                   UnitName{"m/s", Slot::value, 1, 1, ValueUnit::mps},
                                   UnitName{"deg", Slot::value, 1, 1, ValueUnit::degree},
                                   UnitName{"ratio", Slot::value, 1, 1, ValueUnit::ratio},
                                   UnitName{"0.001/s", Slot::value, 1, 1, ValueUnit::per_1000_s},
                                   UnitName{"deg/km", Slot::value, 1, 1, ValueUnit::degree_per_km},
                                   UnitName{"mm/h", Slot::value, 1, 1, ValueUnit::mm_per_h},
                                   UnitName{"de", Slot::image, 1, 1},
                                   UnitName{"s", Slot::time, 1, 1},
                                   UnitName{"ms", Slot::time, 1, 1000}};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return lower;
}

// One part of a budget, "250 m" or "dE 2", as a number and a unit.
struct Part {
    double number = 0;
    std::string unit;
};

Result<Part> split_part(std::string_view text) {
    std::string_view rest = text;
    Part part;
    if (lower_case(text.substr(0, 2)) == "de") {
        part.unit = "de";
        rest = trimmed(text.substr(2));
    }
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), part.number);
    if (error == std::errc::invalid_argument) {
        return fail(ErrorCode::bad_argument, "\"{}\" in the budget is not a number with a unit; {}",
                    printable(text), examples);
    }
    const std::string_view behind =
        trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
    // isfinite() refuses infinities and NaN, and signbit() refuses -0. A comparison would trap on
    // NaN, but neither function makes one.
    if (error != std::errc{} || !std::isfinite(part.number) || std::signbit(part.number)) {
        return fail(ErrorCode::bad_argument,
                    "\"{}\" in the budget must be a finite number and not negative",
                    printable(text));
    }
    if (!part.unit.empty() && !behind.empty()) {
        return fail(ErrorCode::bad_argument, "\"{}\" in the budget has an unknown word, \"{}\"",
                    printable(text), printable(behind));
    }
    if (part.unit.empty()) part.unit = lower_case(behind);
    return part;
}

Status take_part(std::string_view text, Budget& budget) {
    const auto part = split_part(text);
    if (!part) return pass_on(part);
    const auto* const unit =
        std::find_if(unit_names.begin(), unit_names.end(),
                     [&](const UnitName& candidate) { return candidate.name == part->unit; });
    if (unit == unit_names.end()) {
        return fail(ErrorCode::bad_argument,
                    "\"{}\" in the budget has {}; the units are m, km, dB, m/s, deg, ratio, "
                    "0.001/s, deg/km, mm/h, dE, ms and s",
                    printable(text), part->unit.empty() ? "no unit" : "an unknown unit");
    }
    // Test before multiplying, so that no overflow raises a floating-point trap.
    if (part->number > std::numeric_limits<double>::max() / unit->multiply) {
        return fail(ErrorCode::bad_argument, "\"{}\" in the budget is too large", printable(text));
    }
    const double number = part->number * unit->multiply / unit->divide;
    if (unit->slot == Slot::time && number == 0) {
        return fail(ErrorCode::bad_argument, "\"{}\" in the budget: a time must be above zero",
                    printable(text));
    }
    std::optional<double>& slot = unit->slot == Slot::position ? budget.position_m
                                  : unit->slot == Slot::image  ? budget.image_de
                                  : unit->slot == Slot::time   ? budget.time_s
                                                               : budget.value;
    if (slot) {
        return fail(ErrorCode::bad_argument, "\"{}\": the budget already has a {}", printable(text),
                    unit->slot == Slot::position ? "position error"
                    : unit->slot == Slot::image  ? "color error"
                    : unit->slot == Slot::time   ? "time"
                                                 : "value error");
    }
    slot = number;
    if (unit->slot == Slot::value) budget.value_unit = unit->value_unit;
    return {};
}

}  // namespace

std::optional<double> Budget::limit(Quantity quantity) const {
    return figure_of(quantity, position_m, value, image_de);
}

bool Budget::bounds_errors() const {
    return position_m || value || image_de;
}

Result<Budget> parse_budget(std::string_view text) {
    if (text.size() > longest_budget_text) {
        return fail(ErrorCode::bad_argument, "the budget is longer than {} characters",
                    longest_budget_text);
    }
    if (trimmed(text).empty()) {
        return fail(ErrorCode::bad_argument, "the budget is empty; {}", examples);
    }
    Budget budget;
    while (true) {
        const std::size_t comma = text.find(',');
        const std::string_view part = trimmed(text.substr(0, comma));
        if (auto taken = take_part(part, budget); !taken) return pass_on(taken);
        if (comma == std::string_view::npos) return budget;
        text.remove_prefix(comma + 1);
    }
}

std::string format_budget(const Budget& budget) {
    std::vector<std::string> parts;
    if (budget.position_m) parts.push_back(fmt::format("{} m", *budget.position_m));
    if (budget.value) {
        parts.push_back(fmt::format("{} {}", *budget.value, name_of(budget.value_unit)));
    }
    if (budget.image_de) parts.push_back(fmt::format("dE {}", *budget.image_de));
    if (budget.time_s) parts.push_back(fmt::format("{} s", *budget.time_s));
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace stormcellar::accuracy
