// daemon/status/status_board.h -- the status as it was last published, for threads other than the
// service's.
//
// The service posts a copy, at most once a second. Other threads render pages from that copy, so
// that no number of requests costs the service anything. Thread contract: any thread.
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
    // Null before the first copy was posted.
    [[nodiscard]] std::shared_ptr<const StatusSnapshot> latest() const {
        const std::scoped_lock lock(mutex_);
        return latest_;
    }

  private:
    mutable std::mutex mutex_;
    std::shared_ptr<const StatusSnapshot> latest_;
};

}  // namespace stormcellar::daemon
