#include "web/http/work_queue.h"

#include <algorithm>
#include <utility>

namespace stormcellar::web {

WorkQueue::WorkQueue(unsigned workers, std::size_t most_waiting) : most_waiting_(most_waiting) {
    for (unsigned i = 0; i < std::max(1u, workers); ++i)
        threads_.emplace_back([this] { run(); });
}

WorkQueue::~WorkQueue() {
    stop();
}

void WorkQueue::stop() {
    {
        const std::scoped_lock lock(mutex_);
        is_stopping_ = true;
    }
    more_.notify_all();
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

bool WorkQueue::add(Work work) {
    {
        const std::scoped_lock lock(mutex_);
        if (is_stopping_ || waiting_.size() >= most_waiting_) return false;
        waiting_.push_back(std::move(work));
    }
    more_.notify_one();
    return true;
}

std::size_t WorkQueue::waiting() const {
    const std::scoped_lock lock(mutex_);
    return waiting_.size();
}

std::size_t WorkQueue::working() const {
    const std::scoped_lock lock(mutex_);
    return working_;
}

void WorkQueue::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        more_.wait(lock, [&] { return is_stopping_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        const Work work = std::move(waiting_.front());
        waiting_.pop_front();
        ++working_;
        const bool is_stopping = is_stopping_;
        lock.unlock();
        work(is_stopping);
        lock.lock();
        --working_;
    }
}

}  // namespace stormcellar::web
