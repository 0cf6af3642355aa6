// cli/shared/query_options.h -- options and output that several query commands share: times, JSON,
// stations.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cli/shared/commands.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::cli {

// --from and --to as typed, both inclusive. An empty text means no limit.
struct TimeRangeOptions {
    std::string from;
    std::string to;
};
void add_time_range(CLI::App& app, TimeRangeOptions& options);

struct TimeRange {
    std::optional<UtcTime> from, to;
};
// Parses the range. Errors: bad_argument if one of the texts is not a time, or if they are in the
// wrong order.
[[nodiscard]] Result<TimeRange> parse_time_range(const TimeRangeOptions& options);

// Prints the document on stdout, indented by two spaces. Writes characters beyond ASCII as \uXXXX.
// Such escapes mean the same to a program, and keep names from controlling a terminal. Replaces
// bytes that are not UTF-8 by U+FFFD.
void print_json(const nlohmann::json& document);

// Warns on stderr if the newest time that is shown is too far in the future (is_believed()).
void warn_of_future(UtcTime newest);

// Reports on stderr that nothing matched. Returns the exit status.
int report_nothing_matched();

[[nodiscard]] nlohmann::json json_time(const std::optional<UtcTime>& time);  // null for none

// Parses a list such as "KBGM,KENX". Returns the names sorted, each once. Errors: bad_argument.
[[nodiscard]] Result<std::vector<std::string>> parse_stations(const std::string& text);
// Parses "WEST,SOUTH,EAST,NORTH" in degrees. Errors: bad_argument.
[[nodiscard]] Result<pipeline::Bounds> parse_bounds(const std::string& text);
// Returns the stations of the table within --bounds. Errors: bad_argument, also if there are none.
[[nodiscard]] Result<std::vector<std::string>> stations_within(const std::string& bounds);

}  // namespace stormcellar::cli
