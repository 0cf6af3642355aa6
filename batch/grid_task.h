// batch/grid_task.h -- grids what one station sent on one day.
//
// The files are gridded one after the other by the daemon's own chain (pipeline/ingest/ingest.h),
// so a task that was killed continues with the last file of which there is a grid: before it,
// nothing is half done. A bad file is left out with its reason. The chain's catalog is in the
// scratch directory; on the cache there is no lock and no database, and other writers may be at
// work.
//
// Threads   One task at a time in a process, because a process is measured as a whole.
// Errors    io, no_space and others that may pass with another try, or on another machine;
//           busy after a stop; bad_argument and corrupt for a plan that makes no sense.
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
    const std::atomic<bool>& stop;  // once it is set, the task ends after the file that it is at
};

struct TaskOutcome {
    bool stood = false;  // all was done before
    Record record;
};

[[nodiscard]] Result<TaskOutcome> run_grid_task(const Plan& plan, const Task& task,
                                                const TaskOptions& options);

}  // namespace stormcellar::batch
