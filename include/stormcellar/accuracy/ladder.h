// stormcellar/accuracy/ladder.h -- a table of the accuracy and the time of each rung, which is one
// form of a step (stormcellar/accuracy/chain.h).
//
// Each row compares the exact form of the chain with a chain in which one step is at another rung.
// fields() serves the Markdown table and the command line's JSON; its keys name their units, as in
// "value_p99_db". format_table() is for people: it has fewer columns, with words as headings.
//
// Threads   Rows are plain values. All functions are pure except mark_pareto(), which changes its
//           rows.
// Errors    None.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/accuracy/quantity.h"

namespace stormcellar::accuracy {

struct LadderRow {
    std::string step;
    std::size_t rung = 0;
    std::string name;
    double time_s = 0;                  // of the first run, which makes everything anew
    std::optional<double> kept_time_s;  // of a run that reuses what the run before it made
    std::optional<double> position_max_m;
    std::optional<double> position_rms_m;
    std::optional<ErrorSummary> value;  // in the moment's unit
    std::optional<double> image_p99_de;
    std::optional<StatusCounts> status;
    bool pareto = false;
};

// The time by which rows are compared. A row without kept_time_s always uses time_s.
enum class TimeKind { first, kept };

// Sets `pareto` in every row, separately for each step. A row is on the front unless another row of
// its step is at least as good in time, 99th percentile of the value, largest position error and
// 99th percentile of the color, and better in one of them. Rows that are equal in all four figures
// are on the front together. A missing error counts as infinite, so a row cannot win because its
// error was not measured.
void mark_pareto(std::span<LadderRow> rows, TimeKind kind = TimeKind::first);

struct LadderField {
    std::string key;
    std::variant<std::monostate, std::string, std::uint64_t, double, bool> value;  // or null
};
// Returns the fields of a row: the same keys in the same order for every row.
[[nodiscard]] std::vector<LadderField> fields(const LadderRow& row, ValueUnit unit);

// Returns the table as text of at most 100 columns, or more if the figures need it; each line ends
// with "\n". The rungs of a step are below the step's name. A column without any value is omitted,
// and "-" marks a missing value. The headings are "first" (time_s), "further" (kept_time_s),
// "position" (the largest position error), "usual" (root mean square of the value errors), "99 in
// 100" (99th percentile of the value errors), "largest" (the largest value error), "color"
// (image_p99_de), "state" (the share of cells with another status) and "worth it" (`pareto`).
[[nodiscard]] std::string format_table(std::span<const LadderRow> rows, ValueUnit unit);

}  // namespace stormcellar::accuracy
