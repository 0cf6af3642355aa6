#include "cli/shared/query_options.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/number_list.h"
#include "cli/shared/commands.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::cli {

void add_time_range(CLI::App& app, TimeRangeOptions& options) {
    app.add_option("--from", options.from,
                   "Earliest time, in UTC as 2022-03-17T00:08:42Z, or relative as -1h, -2d or now");
    app.add_option("--to", options.to, "Latest time, itself included, written as for --from");
}

Result<TimeRange> parse_time_range(const TimeRangeOptions& options) {
    TimeRange range;
    const UtcTime now = now_utc();
    if (!options.from.empty()) {
        const auto from = parse_utc(options.from, now);
        if (!from) return fail(ErrorCode::bad_argument, "--from: {}", from.error().message);
        range.from = *from;
    }
    if (!options.to.empty()) {
        const auto to = parse_utc(options.to, now);
        if (!to) return fail(ErrorCode::bad_argument, "--to: {}", to.error().message);
        range.to = *to;
    }
    if (range.from && range.to && *range.from > *range.to) {
        return fail(ErrorCode::bad_argument, "--from {} is after --to {}", format_utc(*range.from),
                    format_utc(*range.to));
    }
    return range;
}

void print_json(const nlohmann::json& document) {
    fmt::print("{}\n", document.dump(2, ' ', true, nlohmann::json::error_handler_t::replace));
}

void warn_of_future(UtcTime newest) {
    if (is_believed(newest, now_utc())) return;
    fmt::print(stderr,
               "stormcellar: warning: the newest time, {}, is in the future; the clock of the "
               "radar or of this machine is wrong\n",
               format_utc(newest));
}

int report_nothing_matched() {
    fmt::print(stderr, "stormcellar: nothing matched\n");
    return exit_nothing_matched;
}

nlohmann::json json_time(const std::optional<UtcTime>& time) {
    return time ? nlohmann::json(format_utc(*time)) : nlohmann::json(nullptr);
}

Result<pipeline::Bounds> parse_bounds(const std::string& text) {
    const auto given = parse_numbers(text, ',');
    pipeline::Bounds bounds{};
    if (given && given->size() == bounds.size()) {
        std::copy(given->begin(), given->end(), bounds.begin());
        if (pipeline::is_bounds(bounds)) return bounds;
    }
    return fail(ErrorCode::bad_argument,
                "--bounds takes WEST,SOUTH,EAST,NORTH in degrees, as in -80,40,-72,45, not '{}'",
                text);
}

Result<std::vector<std::string>> stations_within(const std::string& text) {
    const auto bounds = parse_bounds(text);
    if (!bounds) return pass_on(bounds);
    const auto [west, south, east, north] = *bounds;
    std::vector<std::string> stations;
    for (const Station& station : all_stations()) {
        const double longitude = station.longitude_deg;
        const bool fits = west < east ? longitude >= west && longitude <= east
                                      : longitude >= west || longitude <= east;
        if (fits && station.latitude_deg >= south && station.latitude_deg <= north) {
            stations.emplace_back(station.icao);
        }
    }
    if (stations.empty()) {
        return fail(ErrorCode::bad_argument, "--bounds {}: no station is within these bounds",
                    text);
    }
    return stations;
}

}  // namespace stormcellar::cli
