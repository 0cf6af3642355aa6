// cli/batch/task_pool.h -- runs tasks of a plan as processes on this machine, several at a time.
//
// A crash of a task affects no other task, because each task is a process. A task that ends with
// status 75 (exit_try_again) is tried again, up to three times in all.
//
// Threads   One pool at a time, because the pool waits for every child of this process.
// Errors    io or exhausted if a process cannot be started.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::cli {

struct PoolJob {
    std::filesystem::path program, plan;
    const char* command = "run";  // subcommand of `stormcellar batch`
    int jobs = 1;
    int threads = 1;
};

// Runs the tasks in their order. Calls `done` with the number of ended tasks each time a task has
// ended and is not tried again. Once `stop` is set, no further task begins; if a signal set it,
// run_pool() sends SIGTERM to the running tasks. Returns the tasks that failed, without the tasks
// that did not begin. If run_pool() returns an error, running tasks go on.
[[nodiscard]] Result<std::vector<std::size_t>> run_pool(
    const PoolJob& job, const std::vector<std::size_t>& tasks, const std::atomic<bool>& stop,
    const std::function<void(std::size_t done)>& done);

}  // namespace stormcellar::cli
