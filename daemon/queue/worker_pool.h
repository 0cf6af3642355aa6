// daemon/queue/worker_pool.h -- threads that ingest files, or write them into the catalog.
//
// A job is handed over only when a worker is free, so nothing queues here. A worker survives every
// file: an exception becomes an error of the job. Thread contract: one thread owns the pool.
// Workers call `wake`, which must only signal.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "daemon/queue/schedule.h"
#include "daemon/queue/sink.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

struct Finished {
    Job job;
    Result<Taken> taken;
    SteadyTime started, ended;
};

class WorkerPool {
  public:
    // What a worker does with a job. All workers call it.
    using Work = std::function<Result<Taken>(const Job&)>;

    WorkerPool(Work work, const char* thread_name, int workers, std::function<void()> wake);
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;
    ~WorkerPool();  // waits for the running jobs

    // Additional threads start at once; surplus threads end after their job.
    void resize(int workers);
    [[nodiscard]] bool has_free_worker() const;
    void submit(Job job);  // only if a worker is free
    // The jobs that ended since the last call.
    std::vector<Finished> collect();
    // The longest running job, by its file; none if all workers are idle.
    struct Oldest {
        std::filesystem::path path;
        SteadyTime since;
    };
    [[nodiscard]] std::optional<Oldest> oldest() const;
    // Starts no further job; returns true if the running ones ended within the time.
    bool drain(std::chrono::milliseconds within);

  private:
    struct Begun {
        Job job;
        std::multimap<SteadyTime, std::filesystem::path>::iterator entry;  // of running_
    };
    void work();
    std::optional<Begun> wait_for_job();
    Result<Taken> take(const Job& job);

    Work work_;
    const char* thread_name_;
    std::function<void()> wake_;
    mutable std::mutex mutex_;  // guards all members below except threads_
    std::condition_variable changed_;
    std::deque<Job> inbox_;
    std::vector<Finished> outbox_;
    std::multimap<SteadyTime, std::filesystem::path> running_;  // by the time at which each began
    int wanted_ = 0;
    int alive_ = 0;
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace stormcellar::daemon
