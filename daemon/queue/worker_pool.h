// daemon/queue/worker_pool.h -- threads that ingest files or register them in the catalog.
//
// The caller submits a job only if a worker is free, so no jobs queue up here. If processing throws
// an exception, the job fails with that error, and its worker goes on.
//
// Threads   One thread owns the pool. `wake` is called from the workers and must only signal.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <thread>
#include <vector>

#include "daemon/queue/schedule.h"
#include "daemon/queue/sink.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

struct Finished {
    Job job;
    Result<Taken> taken;
    SteadyTime started, ended;
};

class WorkerPool {
  public:
    // Processes a job. It is called from all workers.
    using Work = std::function<Result<Taken>(const Job&)>;

    WorkerPool(Work work, const char* thread_name, int workers, std::function<void()> wake);
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;
    ~WorkerPool();  // waits for the running jobs

    // Changes the number of workers. Additional threads start at once. Surplus threads end after
    // their current jobs.
    void resize(int workers);
    [[nodiscard]] bool has_free_worker() const;
    void submit(Job job);  // call it only if a worker is free
    // Returns the jobs that have ended since the last call.
    std::vector<Finished> collect();
    // Returns the file of the job that has run longest, with its start; none if all workers are
    // idle.
    struct Oldest {
        std::filesystem::path path;
        SteadyTime since;
    };
    [[nodiscard]] std::optional<Oldest> oldest() const;
    // Starts no more jobs. Returns true if the running jobs have ended within `within`.
    bool drain(std::chrono::milliseconds within);

  private:
    struct Begun {
        Job job;
        // The entry of running_ for this job.
        std::multimap<SteadyTime, std::filesystem::path>::iterator entry;
    };
    void work();
    std::optional<Begun> wait_for_job();
    Result<Taken> take(const Job& job);

    Work work_;
    const char* thread_name_;
    std::function<void()> wake_;
    mutable Mutex mutex_;
    ConditionVariable changed_;
    std::deque<Job> inbox_ STORMCELLAR_GUARDED_BY(mutex_);
    std::vector<Finished> outbox_ STORMCELLAR_GUARDED_BY(mutex_);
    // Files of running jobs, by the start of the job.
    std::multimap<SteadyTime, std::filesystem::path> running_ STORMCELLAR_GUARDED_BY(mutex_);
    int wanted_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    int alive_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    bool stopping_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    std::vector<std::thread> threads_;
};

}  // namespace stormcellar::daemon
