// daemon/status/status_board.h -- the status as it was last published, for other threads.
//
// The service posts a copy at most once a second. Readers render pages from that copy in their own
// thread, so that requests, however many, cost the service nothing.
//
// Threads   Thread safe.
#pragma once

#include <memory>
#include <mutex>

#include "daemon/status/status.h"

namespace stormcellar::daemon {

struct StatusSnapshot {
    StatusFacts facts;
    Pending pending;
};

class StatusBoard {
  public:
    void post(const StatusFacts& facts, const Pending& pending) {
        auto fresh = std::make_shared<const StatusSnapshot>(StatusSnapshot{facts, pending});
        const std::scoped_lock lock(mutex_);
        latest_.swap(fresh);
    }
    // Returns null before the first status was posted.
    [[nodiscard]] std::shared_ptr<const StatusSnapshot> latest() const {
        const std::scoped_lock lock(mutex_);
        return latest_;
    }

  private:
    mutable std::mutex mutex_;
    std::shared_ptr<const StatusSnapshot> latest_;
};

}  // namespace stormcellar::daemon
