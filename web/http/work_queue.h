// web/http/work_queue.h -- a limited number of threads that make answers, and a limited number of
// requests that wait for them.
//
// Clients share the threads. A thread that becomes free takes work of the client for which the
// fewest threads work. If several clients have equally few, it takes the client that came, or whose
// last turn ended, longest ago. If all waiting places are taken, a new request takes the place of
// another client's newest waiting request. That client is the one with the most requests, and it
// must have at least two more than the client of the new request.
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
    // Runs the waiting work with `stopping`, so that each request gets an answer at once.
    ~WorkQueue();

    // Tells the work why it is run: its turn has come, the queue stops, or another client's work
    // has taken its place. Work must not throw.
    enum class Turn { came, stopping, lost };
    using Work = std::function<void(Turn turn)>;
    // Adds work. Returns false if the queue stops, or if too much work waits and this work can take
    // no other's place. If it takes a place, the caller's thread runs the work that has lost the
    // place, with Turn::lost.
    [[nodiscard]] bool add(const std::string& client, Work work);
    void stop();
    [[nodiscard]] std::size_t waiting() const;
    [[nodiscard]] std::size_t working() const;

  private:
    struct Client {
        std::deque<Work> waiting;
        std::size_t working = 0;
        std::uint64_t last_turn = 0;  // turns_ when it came, or when its last turn ended
        [[nodiscard]] std::size_t requests() const { return waiting.size() + working; }
    };
    using Clients = std::map<std::string, Client>;
    void run() STORMCELLAR_EXCLUDES(mutex_);
    [[nodiscard]] Clients::iterator next() STORMCELLAR_REQUIRES(mutex_);
    // Removes and returns the newest waiting work of the client with the most requests, if this
    // client has more than `requests` + 1.
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
