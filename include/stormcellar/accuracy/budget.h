// stormcellar/accuracy/budget.h -- the error, or the time, that a user allows.
//
// A budget bounds MODEL error: a rung against the chain's exact form on the same gates. How well
// the radar sampled the storm is another thing, which is reported and never budgeted.
//   position_m  largest distance between where a cell's sample is taken and where it should be
//   value       99th percentile over the cells valued in both, in the unit of the moment
//   image_de    99th percentile over the pixels, CIEDE2000
//   time_s      of the whole chain, wall clock
// An error of 0 means exact: only what is predicted to change nothing may be left off. A time of
// 0 is refused. What is not budgeted is not bounded.
// Errors: bad_argument, naming the part that was not understood.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/accuracy/quantity.h"
#include "stormcellar/base/result.h"

namespace stormcellar::accuracy {

struct Budget {
    std::optional<double> position_m;
    std::optional<double> value;
    ValueUnit value_unit = ValueUnit::db;  // of `value`
    std::optional<double> image_de;
    std::optional<double> time_s;

    [[nodiscard]] std::optional<double> limit(Quantity quantity) const;
    // Whether any error is bounded; else the budget is a time alone, or empty.
    [[nodiscard]] bool bounds_errors() const;
    bool operator==(const Budget&) const = default;
};

inline constexpr std::size_t longest_budget_text = 200;

// Parts in any order, with commas between, each quantity once: "250 m, 0.5 dB", "0.5 m/s", "dE 2",
// "20 ms". Units m, km, dB, m/s, deg, ratio, dE (before or behind its number), ms, s, in any case.
[[nodiscard]] Result<Budget> parse_budget(std::string_view text);

// parse_budget(format_budget(b)) == b for every budget that parse_budget gives.
[[nodiscard]] std::string format_budget(const Budget& budget);

}  // namespace stormcellar::accuracy
