// cli/batch/task_pool.h -- runs tasks of a plan as processes on this machine, several at a time.
//
// Each task is a process, so a crash affects no other task. A task that ends with status 75 is
// tried again, up to three times in all.
//
// Threads   One pool at a time; it waits for all children of the process.
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

// Runs the tasks in their order. Once `stop` is set, no further task begins; when a signal has set
// it, run_pool() also sends SIGTERM to the running tasks. Calls `done` with the number of ended
// tasks after each task that is not tried again. Returns the tasks that failed, without those that
// did not begin. After an error, running tasks go on.
[[nodiscard]] Result<std::vector<std::size_t>> run_pool(
    const PoolJob& job, const std::vector<std::size_t>& tasks, const std::atomic<bool>& stop,
    const std::function<void(std::size_t done)>& done);

}  // namespace stormcellar::cli
