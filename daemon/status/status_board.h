// daemon/status/status_board.h -- holds the last published status for other threads.
//
// The service posts a copy of its status at most once a second. Readers render pages from that copy
// in their own threads. So requests, however many, cost the service nothing.
//
// Threads   Thread safe.
#pragma once

#include <memory>

#include "daemon/status/status.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::daemon {

struct StatusSnapshot {
    StatusFacts facts;
    Pending pending;
};

class StatusBoard {
  public:
    void post(const StatusFacts& facts, const Pending& pending) {
        auto fresh = std::make_shared<const StatusSnapshot>(StatusSnapshot{facts, pending});
        const MutexLock lock(mutex_);
        latest_.swap(fresh);
    }
    // Returns the status that was posted last, or null if none was.
    [[nodiscard]] std::shared_ptr<const StatusSnapshot> latest() const {
        const MutexLock lock(mutex_);
        return latest_;
    }

  private:
    mutable Mutex mutex_;
    std::shared_ptr<const StatusSnapshot> latest_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::daemon
