// batch/grid_task.h -- grids the files of one station and day.
//
// The daemon's own chain (pipeline/ingest/ingest.h) grids the files one after the other, so a task
// that was killed continues with the last file that has a grid; all files before it are complete. A
// bad file is left out with its reason. The chain's catalog is in the scratch directory. The task
// puts no lock and no database on the cache, so other writers may be at work there.
//
// Threads   One task at a time in a process, because the resources of the whole process are
// measured.
// Errors    io, no_space and others that another try or another machine may not have; busy after a
//           stop; bad_argument and corrupt for a plan that makes no sense.
#pragma once

#include <atomic>
#include <filesystem>

#include "batch/plan.h"
#include "batch/record.h"
#include "stormcellar/base/result.h"

namespace stormcellar::batch {

struct TaskOptions {
    int threads = 1;
    std::filesystem::path scratch;  // local, empty, and removed by the caller
    const std::atomic<bool>& stop;  // once it is set, the task ends after its current file
};

struct TaskOutcome {
    bool stood = false;  // everything was done before
    Record record;
};

[[nodiscard]] Result<TaskOutcome> run_grid_task(const Plan& plan, const Task& task,
                                                const TaskOptions& options);

}  // namespace stormcellar::batch
