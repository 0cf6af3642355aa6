// stormcellar/accuracy/budget.h -- the error or the time that a user allows.
//
// A budget bounds the model error: the difference between a chosen form of a chain and its exact
// form (stormcellar/accuracy/chain.h), on the same gates. It does not bound how well the radar
// sampled the storm; that error is reported, but has no budget.
//   position_m  largest distance from the point that a cell should sample to the point it samples
//   value       99th percentile over cells with a value in both forms, in the unit of the moment
//   image_de    99th percentile over the pixels, CIEDE2000
//   time_s      wall clock time of the whole chain
// An error of 0 means exact: the planner may then leave off only effects whose predicted size is 0.
// A time of 0 is refused. A quantity without a budget is not bounded.
//
// Units     Each member names its unit; `value` is in `value_unit`.
// Threads   Budgets are plain values and all functions are pure, so any thread may use them.
// Errors    parse_budget() returns bad_argument; the message names the mistake.
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
    ValueUnit value_unit = ValueUnit::db;  // the unit of `value`
    std::optional<double> image_de;
    std::optional<double> time_s;

    // Returns the limit of one quantity, or none if the budget does not bound it.
    [[nodiscard]] std::optional<double> limit(Quantity quantity) const;
    // Returns true if any error is bounded; false if the budget has only a time, or nothing.
    [[nodiscard]] bool bounds_errors() const;
    bool operator==(const Budget&) const = default;
};

// The greatest number of bytes that parse_budget() accepts.
inline constexpr std::size_t longest_budget_text = 200;

// Parses the parts of a budget, separated by commas: "250 m, 0.5 dB", "0.5 m/s", "dE 2", "20 ms".
// The parts may be in any order; each quantity may occur once. The units are m, km, dB, m/s, deg,
// ratio, dE (before or after its number), ms and s, in upper or lower case.
[[nodiscard]] Result<Budget> parse_budget(std::string_view text);

// Writes a budget as text that parse_budget() reads back without loss.
[[nodiscard]] std::string format_budget(const Budget& budget);

}  // namespace stormcellar::accuracy
