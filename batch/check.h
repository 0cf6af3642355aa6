// batch/check.h -- finds which tasks of a plan are done, from their records.
//
// The records of a thousand tasks share a directory. The task that writes the last record of
// PLAN/tasks/00012 also writes the sum of these records to summary.json in that directory. The
// summary appears by rename, and every process computes the same sum from the same records. With
// summaries, checking a plan of millions of tasks reads only thousands of files.
//
// Threads   One thread at a time may check a plan; other processes may check it at the same time.
// Errors    Those of reading the plan and, with `deep`, of reading grids.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "batch/plan.h"
#include "batch/record.h"
#include "batch/totals.h"
#include "stormcellar/base/result.h"

namespace stormcellar::batch {

struct CheckReport {
    Totals done;
    std::vector<std::size_t> missing;  // tasks that are not done, ascending
    // missing tasks whose record does not fit the cache; with `deep` only
    std::vector<std::size_t> changed;
    double cost_left_s = 0;  // estimated processor time of the missing tasks
    // Time until all tasks are done, estimated from the work since the first task began. None
    // before the first task is done.
    std::optional<double> seconds_left;
};

struct CheckOptions {
    bool deep = false;  // compare the grids with the records
    std::function<void(std::size_t done, std::size_t all)> progress;
};

[[nodiscard]] Result<CheckReport> check(const Plan& plan, const CheckOptions& options);

// Writes the record of a task. If the record's directory then has all of its records, writes the
// directory's summary, too.
[[nodiscard]] Status keep_record(const Plan& plan, const Record& record);

// Removes the record of a task and the summary that includes the record, so that the task counts as
// not done.
[[nodiscard]] Status drop_record(const Plan& plan, const Task& task);

// A file that a task left out, with the reason.
struct LeftOutFile {
    std::size_t task = 0;
    NamedReason file;
};
// Returns the files that tasks left out, as their records say. Skips tasks without a record.
[[nodiscard]] std::vector<LeftOutFile> left_out_of(const Plan& plan,
                                                   const std::vector<std::size_t>& tasks);

}  // namespace stormcellar::batch
