// stormcellar/accuracy/ladder.h -- the table of accuracy against time, a row for each rung.
//
// Each row is a step at one rung with everything else exact, compared with the chain's exact form.
// The same fields make the text table, the Markdown table and, in the command line, the JSON, so
// that all three have the same columns: keys with their units, as in "value_p99_db". Thread
// contract: values and pure functions.
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
    double time_s = 0;                  // the first time, everything made anew
    std::optional<double> kept_time_s;  // with what can be kept from one volume to the next
    std::optional<double> position_max_m;
    std::optional<double> position_rms_m;
    std::optional<ErrorSummary> value;  // in the moment's unit
    std::optional<double> image_p99_de;
    std::optional<StatusCounts> status;
    bool pareto = false;
};

enum class TimeKind { first, kept };  // rows without a kept time count with their first

// Sets `pareto` of every row, each step by itself. A row is on the front unless another of its step
// is at least as good in time, 99th percentile of value, largest position error and 99th percentile
// of colour, and better in one of them. Rows that are equal in all are on it together. An error
// that a row lacks counts as infinite: what was not measured wins nothing.
void mark_pareto(std::span<LadderRow> rows, TimeKind kind = TimeKind::first);

struct LadderField {
    std::string key;
    std::variant<std::monostate, std::string, std::uint64_t, double, bool> value;  // none: null
};
// The same keys in the same order for every row.
[[nodiscard]] std::vector<LadderField> fields(const LadderRow& row, ValueUnit unit);

// Columns that no row has a value in are left out; "-" where a row has none. Lines end with "\n".
[[nodiscard]] std::string format_table(std::span<const LadderRow> rows, ValueUnit unit);

}  // namespace stormcellar::accuracy
