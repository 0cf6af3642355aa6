// web/http/work_queue.h -- a bounded number of threads that make answers, and a bounded number of
// waiting requests.
//
// Clients share the threads. The next turn goes to the client with the fewest requests being
// answered; among equals, to the client that came, or whose last turn ended, longest ago. If all
// places are taken, a new request takes the place of the newest waiting request of the client with
// most requests, if that client has at least two more.
//
// Threads   Many threads may add work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "stormcellar/base/mutex.h"

namespace stormcellar::web {

class WorkQueue {
  public:
    WorkQueue(unsigned workers, std::size_t most_waiting);
    WorkQueue(const WorkQueue&) = delete;
    WorkQueue& operator=(const WorkQueue&) = delete;
    // Runs waiting work with `stopping`, so that it answers at once.
    ~WorkQueue();

    // The reason for which work is run: its turn has come, the queue stops, or another client took
    // its place. Work must not throw.
    enum class Turn { came, stopping, lost };
    using Work = std::function<void(Turn turn)>;
    // Returns false if too much work waits already. If this work takes the place of other work, the
    // caller's thread runs the other work with `lost`.
    [[nodiscard]] bool add(const std::string& client, Work work);
    void stop();
    [[nodiscard]] std::size_t waiting() const;
    [[nodiscard]] std::size_t working() const;

  private:
    struct Client {
        std::deque<Work> waiting;
        std::size_t working = 0;
        std::uint64_t last_turn = 0;  // or when it came, in units of turns_
        [[nodiscard]] std::size_t requests() const { return waiting.size() + working; }
    };
    using Clients = std::map<std::string, Client>;
    void run() STORMCELLAR_EXCLUDES(mutex_);
    [[nodiscard]] Clients::iterator next() STORMCELLAR_REQUIRES(mutex_);
    // Takes the newest waiting work of the client with most requests, if these are more than
    // `requests` + 1.
    [[nodiscard]] std::optional<Work> take_place_of_other(std::size_t requests)
        STORMCELLAR_REQUIRES(mutex_);
    void forget_if_idle(Clients::iterator client) STORMCELLAR_REQUIRES(mutex_);

    const std::size_t most_waiting_;
    mutable Mutex mutex_;
    ConditionVariable more_;
    Clients clients_ STORMCELLAR_GUARDED_BY(mutex_);  // only clients with requests
    std::size_t waiting_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::size_t working_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::uint64_t turns_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    bool is_stopping_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    std::vector<std::thread> threads_;
};

}  // namespace stormcellar::web
