// batch/engines.h -- writes scripts for Slurm and make that run the tasks that are not done.
//
// An engine only starts tasks. Records decide which tasks are done, so a task that the engine loses
// is submitted again by the next script.
//
// Threads   Pure functions.
// Errors    Those of reading the plan.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "batch/plan.h"
#include "stormcellar/base/result.h"

namespace stormcellar::batch {

struct EngineOptions {
    std::filesystem::path program = "stormcellar";  // a name or path on every machine
    int jobs = 0;     // tasks that run at a time; 0: as many as the engine allows
    int threads = 1;  // for each task
    std::string partition = {};
    // Slurm refuses arrays whose numbers reach its MaxArraySize, which is 1001 by default. If a
    // plan has more tasks, each element of the array gets several.
    std::size_t array_size = 1000;
};

// Returns bad_argument if the plan's directory, the program or the partition has characters that a
// script cannot hold, such as a line feed.
[[nodiscard]] Status check_names(const Plan& plan, const EngineOptions& options);

// The tasks that are not done, by kind. An engine runs grid tasks first, then frame tasks, then
// statistics tasks.
struct TaskLists {
    std::vector<std::size_t> grids, frames, statistics;
};
[[nodiscard]] TaskLists lists_of(const Plan& plan, const std::vector<std::size_t>& missing);

// A job array of Slurm.
struct SlurmJob {
    std::string name;  // "grids", "frames" or "statistics"
    std::string text;  // the script
};
// Returns the jobs in the order of submission. The caller must make each job wait until the job
// before it has ended.
[[nodiscard]] std::vector<SlurmJob> slurm_jobs(const Plan& plan, const TaskLists& tasks,
                                               const EngineOptions& options);

[[nodiscard]] Result<std::string> makefile_of(const Plan& plan, const TaskLists& tasks,
                                              const EngineOptions& options);

// Returns the text in quotes for a shell.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace stormcellar::batch
