// batch/grid_task.h -- grids the files of one station and day.
//
// The chain that the daemon uses (pipeline/ingest/ingest.h) grids the files one after the other. A
// run after a killed run begins with the last file that has a grid, because this file may lack the
// grids of some moments. A bad file is left out, and the record says why. The chain keeps its
// catalog in the scratch directory. The task puts no lock and no database on the cache, so other
// writers may use the cache at the same time.
//
// Threads   One task at a time in a process, because Usage measures the whole process.
// Errors    io, no_space and others, after which another try or another machine may succeed; busy
//           after a stop; bad_argument and corrupt for a plan that makes no sense.
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
    const std::atomic<bool>& stop;  // if it becomes true, the task ends after its current file
};

struct TaskOutcome {
    bool stood = false;  // an earlier run had made all grids, so this run made none
    Record record;
};

[[nodiscard]] Result<TaskOutcome> run_grid_task(const Plan& plan, const Task& task,
                                                const TaskOptions& options);

}  // namespace stormcellar::batch
