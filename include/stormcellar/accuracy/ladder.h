// stormcellar/accuracy/ladder.h -- the table of accuracy against time, with a row for each rung.
//
// Each row describes a step at one rung, with everything else exact, compared with the exact form
// of the chain. The Markdown table and (in the command line) the JSON are made from the same
// fields. The keys name their units, as in "value_p99_db". The text table is for people: it has
// fewer columns, with words for headings.
//
// Threads   Rows are plain values and all functions are pure, but for mark_pareto(), which changes
//           the rows that it is given.
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
    double time_s = 0;                  // the time of the first run, which makes everything anew
    std::optional<double> kept_time_s;  // the time if the next volume reuses what one volume leaves
    std::optional<double> position_max_m;
    std::optional<double> position_rms_m;
    std::optional<ErrorSummary> value;  // in the moment's unit
    std::optional<double> image_p99_de;
    std::optional<StatusCounts> status;
    bool pareto = false;
};

// the time that counts; a row without a kept time counts with its first
enum class TimeKind { first, kept };

// Sets `pareto` in every row, for each step by itself. A row is on the front unless another row of
// its step is at least as good in time, 99th percentile of the value, largest position error and
// 99th percentile of the color, and better in one of them. Rows that are equal in all of these are
// on the front together. A missing error counts as infinite, so a row cannot win by not being
// measured.
void mark_pareto(std::span<LadderRow> rows, TimeKind kind = TimeKind::first);

struct LadderField {
    std::string key;
    std::variant<std::monostate, std::string, std::uint64_t, double, bool> value;  // null if empty
};
// Returns the fields of a row: the same keys in the same order for every row.
[[nodiscard]] std::vector<LadderField> fields(const LadderRow& row, ValueUnit unit);

// Returns the table as text of at most 100 columns; each line ends with "\n". The rungs of a step
// are below its name. A column without any value is left out, and "-" marks a missing value.
// "first" is time_s, "further" kept_time_s, and "position" the largest position error. "usual", "99
// in 100" and "largest" are the root mean square, the 99th percentile and the largest of the
// values. "state" is the share of cells in another state, and "worth it" is `pareto`.
[[nodiscard]] std::string format_table(std::span<const LadderRow> rows, ValueUnit unit);

}  // namespace stormcellar::accuracy
