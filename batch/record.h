// batch/record.h -- the result of a task, in a file that appears when the task is done.
//
// PLAN/tasks/00012/12345.json is the record of task 12345; a directory has a thousand records. A
// directory that has all of its records also has their sum (batch/check.h). docs/guides/batch.md
// lists the fields.
//
// A record appears by rename. If two runs of a task overlap, the record written later replaces the
// other; both runs make the same grids.
//
// Units     Seconds, bytes; times are UTC.
// Threads   Functions without state.
// Errors    Those of reading and writing files; corrupt.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "batch/plan.h"
#include "stormcellar/base/result.h"

namespace stormcellar::batch {

struct NamedReason {
    std::string name;  // of a file, without directories; the same text for all frames
    std::string reason;
};

using HourCounts = std::array<std::uint32_t, 24>;  // by the hour of the day, UTC

struct Record {
    std::size_t number = 0;
    std::string plan;  // hash of the plan's recipe
    TaskKind kind = TaskKind::grids;
    std::string station;  // of a grid task
    std::string day;      // of a grid task, as 20130520
    // Number of raw files, whether gridded or left out; and number of grids, frames or files of
    // counts that exist.
    std::size_t files = 0;
    std::size_t grids = 0;
    std::string digest;  // of all bytes of the grids
    // raw files that were not gridded; for frames: damaged grids
    std::vector<NamedReason> left_out;
    std::vector<NamedReason> notes;  // files that were gridded, with a remark
    HourCounts taken_by_hour{}, left_out_by_hour{};
    // Resources that the last run of the task used. They are lower if an earlier run had made some
    // grids.
    UtcTime started, ended;
    double cpu_s = 0;
    std::uint64_t bytes_read = 0, bytes_written = 0, memory_bytes = 0;
    std::string host;
};

inline constexpr std::size_t records_a_directory = 1000;
[[nodiscard]] std::filesystem::path record_path(const std::filesystem::path& plan,
                                                std::size_t number);

// Returns the text of the record's file.
[[nodiscard]] std::string text_of(const Record& record);
[[nodiscard]] Status write_record(const std::filesystem::path& plan, const Record& record);
// Returns none if the record is missing, damaged, or of another recipe or task.
[[nodiscard]] std::optional<Record> read_record(const Plan& plan, const Task& task);
[[nodiscard]] Result<Record> parse_record(std::string_view text);

}  // namespace stormcellar::batch
