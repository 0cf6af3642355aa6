#include "daemon/queue/worker_pool.h"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include <pthread.h>

namespace stormcellar::daemon {

WorkerPool::WorkerPool(Work work, const char* thread_name, int workers, std::function<void()> wake)
    : work_(std::move(work)), thread_name_(thread_name), wake_(std::move(wake)) {
    resize(workers);
}

WorkerPool::~WorkerPool() {
    {
        const MutexLock lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

void WorkerPool::resize(int workers) {
    int missing = 0;
    {
        const MutexLock lock(mutex_);
        wanted_ = std::max(1, workers);
        missing = std::max(0, wanted_ - alive_);
        alive_ += missing;
    }
    changed_.notify_all();
    for (int i = 0; i < missing; ++i)
        threads_.emplace_back([this] { work(); });
}

bool WorkerPool::has_free_worker() const {
    const MutexLock lock(mutex_);
    return !stopping_ && static_cast<int>(running_.size() + inbox_.size()) < wanted_;
}

void WorkerPool::submit(Job job) {
    {
        const MutexLock lock(mutex_);
        inbox_.push_back(std::move(job));
    }
    changed_.notify_one();
}

std::vector<Finished> WorkerPool::collect() {
    const MutexLock lock(mutex_);
    return std::exchange(outbox_, {});
}

std::optional<WorkerPool::Oldest> WorkerPool::oldest() const {
    const MutexLock lock(mutex_);
    if (running_.empty()) return std::nullopt;
    return Oldest{running_.begin()->second, running_.begin()->first};
}

bool WorkerPool::drain(std::chrono::milliseconds within) {
    const SteadyTime end = std::chrono::steady_clock::now() + within;
    const MutexLock lock(mutex_);
    stopping_ = true;
    inbox_.clear();
    changed_.notify_all();
    while (!running_.empty() && std::chrono::steady_clock::now() < end)
        changed_.wait_until(mutex_, end);
    return running_.empty();
}

std::optional<WorkerPool::Begun> WorkerPool::wait_for_job() {
    const MutexLock lock(mutex_);
    while (!stopping_ && alive_ <= wanted_ && inbox_.empty())
        changed_.wait(mutex_);
    if (stopping_ || inbox_.empty()) {
        --alive_;
        return std::nullopt;
    }
    Job job = std::move(inbox_.front());
    inbox_.pop_front();
    const auto entry = running_.emplace(std::chrono::steady_clock::now(), job.path);
    return Begun{std::move(job), entry};
}

Result<Taken> WorkerPool::take(const Job& job) {
    try {
        return work_(job);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::exhausted, "there is not enough memory for it");
    } catch (const std::exception& error) {
        return fail(ErrorCode::internal, "{}: {}", job.path.native(), error.what());
    }
}

void WorkerPool::work() {
    ::pthread_setname_np(::pthread_self(), thread_name_);
    while (std::optional<Begun> begun = wait_for_job()) {
        Result<Taken> taken = take(begun->job);
        const SteadyTime ended = std::chrono::steady_clock::now();
        {
            const MutexLock lock(mutex_);
            const SteadyTime started = begun->entry->first;
            running_.erase(begun->entry);
            outbox_.push_back({std::move(begun->job), std::move(taken), started, ended});
        }
        changed_.notify_all();
        wake_();
    }
}

}  // namespace stormcellar::daemon
