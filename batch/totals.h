// batch/totals.h -- sums up the records of tasks.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "batch/record.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::batch {

// Counts of the raw files of a station, by the hour of the day (UTC).
struct StationHours {
    HourCounts taken{}, left_out{};
};

struct Totals {
    std::size_t grid_tasks = 0, frame_tasks = 0, statistics_tasks = 0;  // done
    std::size_t files = 0, left_out = 0, grids = 0, frames = 0;
    [[nodiscard]] std::size_t tasks() const { return grid_tasks + frame_tasks + statistics_tasks; }
    // processor time that the tasks used, and that the plan estimated
    double cpu_s = 0, cost_s = 0;
    std::uint64_t bytes_read = 0, bytes_written = 0, most_memory_bytes = 0;
    std::optional<UtcTime> started, ended;  // first start, and last end
    std::map<std::string, StationHours> stations;
    std::vector<std::size_t> with_left_out;  // tasks that left files out
};

// Adds the record of a task. `cost_s` is the processor time that the plan estimated for the task.
void add(const Record& record, double cost_s, Totals& totals);
void add(const Totals& more, Totals& all);

// Returns the totals as JSON. They must include at least one record.
[[nodiscard]] nlohmann::ordered_json json_of(const Totals& totals);
// Reads totals. Throws the exceptions of nlohmann::json if a field is missing or has the wrong
// type.
[[nodiscard]] Totals totals_of(const nlohmann::ordered_json& json);

}  // namespace stormcellar::batch
