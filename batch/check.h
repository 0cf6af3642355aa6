// batch/check.h -- how far a plan is done, by the records of its tasks.
//
// The records of a thousand tasks are summed up by the last of these tasks, in
// PLAN/tasks/00012/summary.json, which appears by rename: the sum of the same records is the same
// whoever writes it. So checking a plan of millions of tasks reads thousands of files.
//
// Threads   One thread at a time for a plan; other processes may check it, too.
// Errors    Those of reading the plan and, with `deep`, the cache.
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
    std::vector<std::size_t> missing;  // tasks that are not done, rising
    std::vector<std::size_t> changed;  // of these, tasks whose grids are not those of their record
    double cost_left_s = 0;            // of the missing tasks, as the plan estimates them
    // By what was done since the first task began; none before the first one is done.
    std::optional<double> seconds_left;
};

struct CheckOptions {
    bool deep = false;  // compares the grids with what the records say
    std::function<void(std::size_t done, std::size_t all)> progress;
};

[[nodiscard]] Result<CheckReport> check(const Plan& plan, const CheckOptions& options);

// Writes the record of a task, and the summary of its directory if it was the last one there.
[[nodiscard]] Status keep_record(const Plan& plan, const Record& record);

// Removes the record of a task and the summary that has it, so that the task counts as not done.
[[nodiscard]] Status drop_record(const Plan& plan, const Task& task);

// Returns what tasks left out, with reasons, from their records.
struct LeftOutFile {
    std::size_t task = 0;
    NamedReason file;
};
[[nodiscard]] std::vector<LeftOutFile> left_out_of(const Plan& plan,
                                                   const std::vector<std::size_t>& tasks);

}  // namespace stormcellar::batch
