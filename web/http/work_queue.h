// web/http/work_queue.h -- a bounded number of threads that make answers, and of requests that
// wait.
//
// Threads   Many threads may add work.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace stormcellar::web {

class WorkQueue {
  public:
    WorkQueue(unsigned workers, std::size_t most_waiting);
    WorkQueue(const WorkQueue&) = delete;
    WorkQueue& operator=(const WorkQueue&) = delete;
    // Work that waits is run with `is_stopping`, so that it answers at once.
    ~WorkQueue();

    using Work = std::function<void(bool is_stopping)>;
    // Returns false if too much waits already.
    [[nodiscard]] bool add(Work work);
    void stop();
    [[nodiscard]] std::size_t waiting() const;
    [[nodiscard]] std::size_t working() const;

  private:
    void run();

    const std::size_t most_waiting_;
    mutable std::mutex mutex_;
    std::condition_variable more_;
    std::deque<Work> waiting_;
    std::size_t working_ = 0;
    bool is_stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace stormcellar::web
