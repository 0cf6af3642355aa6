#include "web/http/work_queue.h"

#include <algorithm>
#include <system_error>
#include <tuple>
#include <utility>

namespace stormcellar::web {

WorkQueue::WorkQueue(unsigned workers, std::size_t most_waiting) : most_waiting_(most_waiting) {
    try {
        for (unsigned i = 0; i < std::max(1u, workers); ++i)
            threads_.emplace_back([this] { run(); });
    } catch (const std::system_error&) {
        // The system gives no further thread, so the existing threads do the work.
        if (threads_.empty()) throw;
    }
}

WorkQueue::~WorkQueue() {
    stop();
}

void WorkQueue::stop() {
    {
        const MutexLock lock(mutex_);
        is_stopping_ = true;
    }
    more_.notify_all();
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

bool WorkQueue::add(const std::string& client, Work work) {
    std::optional<Work> lost;
    {
        const MutexLock lock(mutex_);
        if (is_stopping_) return false;
        const auto known = clients_.find(client);
        // Each idle thread takes a piece of work at once, so that many pieces do not count as
        // waiting.
        if (waiting_ >= most_waiting_ + (threads_.size() - working_)) {
            lost = take_place_of_other(known == clients_.end() ? 0 : known->second.requests());
            if (!lost) return false;
        }
        Client& own = clients_[client];
        if (own.requests() == 0) own.last_turn = ++turns_;
        own.waiting.push_back(std::move(work));
        ++waiting_;
    }
    more_.notify_one();
    if (lost) (*lost)(Turn::lost);
    return true;
}

std::optional<WorkQueue::Work> WorkQueue::take_place_of_other(std::size_t requests) {
    auto most = clients_.end();
    for (auto client = clients_.begin(); client != clients_.end(); ++client) {
        if (client->second.waiting.empty()) continue;
        if (most == clients_.end() || client->second.requests() > most->second.requests())
            most = client;
    }
    if (most == clients_.end() || most->second.requests() <= requests + 1) return std::nullopt;
    Work work = std::move(most->second.waiting.back());
    most->second.waiting.pop_back();
    --waiting_;
    return work;
}

WorkQueue::Clients::iterator WorkQueue::next() {
    auto best = clients_.end();
    const auto rank = [](const Client& client) {
        return std::tuple(client.working, client.last_turn);
    };
    for (auto client = clients_.begin(); client != clients_.end(); ++client) {
        if (client->second.waiting.empty()) continue;
        if (best == clients_.end() || rank(client->second) < rank(best->second)) best = client;
    }
    return best;
}

void WorkQueue::forget_if_idle(Clients::iterator client) {
    if (client->second.requests() == 0) clients_.erase(client);
}

std::size_t WorkQueue::waiting() const {
    const MutexLock lock(mutex_);
    return waiting_;
}

std::size_t WorkQueue::working() const {
    const MutexLock lock(mutex_);
    return working_;
}

void WorkQueue::run() {
    const MutexLock lock(mutex_);
    while (true) {
        while (!is_stopping_ && waiting_ == 0)
            more_.wait(mutex_);
        if (waiting_ == 0) return;
        const auto client = next();
        const Work work = std::move(client->second.waiting.front());
        client->second.waiting.pop_front();
        ++client->second.working;
        --waiting_;
        ++working_;
        const Turn turn = is_stopping_ ? Turn::stopping : Turn::came;
        {
            const MutexUnlock unlocked(mutex_);
            work(turn);
        }
        --working_;
        --client->second.working;
        client->second.last_turn = ++turns_;
        forget_if_idle(client);
    }
}

}  // namespace stormcellar::web
