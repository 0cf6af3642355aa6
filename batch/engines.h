// batch/engines.h -- what Slurm and make are told: scripts that run the tasks which are not done.
//
// An engine only starts tasks. What is done is judged by the records, so whatever an engine loses
// is submitted again.
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
    std::filesystem::path program = "stormcellar";  // as the machines find it
    int jobs = 0;     // tasks at a time; 0: as many as the engine lets run
    int threads = 1;  // of each task
    std::string partition = {};
    // Slurm takes no array whose numbers reach its MaxArraySize, which is 1001 by default. Plans of
    // more tasks give several to each element of the array.
    std::size_t array_size = 1000;
};

// Returns bad_argument if a script cannot name the plan's directory, the program or the partition:
// a line of it would end within the name.
[[nodiscard]] Status check_names(const Plan& plan, const EngineOptions& options);

// The tasks that are not done, in three steps: grids, then frames, then statistics.
struct TaskLists {
    std::vector<std::size_t> grids, frames, statistics;
};
[[nodiscard]] TaskLists lists_of(const Plan& plan, const std::vector<std::size_t>& missing);

// A job array of Slurm.
struct SlurmJob {
    std::string name;  // "grids", "frames" or "statistics"
    std::string text;  // of the script
};
// Returns the jobs in the order in which they are to be submitted; each begins when the one before
// it has ended.
[[nodiscard]] std::vector<SlurmJob> slurm_jobs(const Plan& plan, const TaskLists& tasks,
                                               const EngineOptions& options);

[[nodiscard]] Result<std::string> makefile_of(const Plan& plan, const TaskLists& tasks,
                                              const EngineOptions& options);

// Returns the text in quotes, as a shell reads it back.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace stormcellar::batch
