// daemon/care/cache_keeper.h -- keeps the cache within its budgets while the service runs.
//
// The keeper rolls the cache (evicts grids beyond the budgets) every 5 seconds, so it notices a
// full file system within 10 seconds. A roll may remove thousands of files, so it runs in a thread
// of its own. The log says how many grids were evicted, and their size. If something keeps the
// cache over its budgets, the log says why: at once, and then every 10 minutes.
//
// Threads   One thread at a time. `wake` is called from the thread of the roll and must only
//           signal.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <utility>

#include "base/steady_time.h"
#include "daemon/queue/sink.h"
#include "service/pulse.h"

namespace stormcellar::daemon {

class CacheKeeper {
  public:
    static constexpr std::chrono::seconds period{5};
    static constexpr std::chrono::minutes reminder{10};

    CacheKeeper(Sink& sink, std::function<void()> wake) : sink_(sink), wake_(std::move(wake)) {}

    // Takes the result of the last roll if it has ended, and starts the next roll if it is due.
    // Returns the contents of the cache if they have changed, else none.
    std::optional<cache::StoreUsage> poll(SteadyTime now, const cache::Budgets& budgets);
    void roll_soon() { next_ = {}; }  // call when the budgets have changed
    // Returns when poll() next has something to do. When a roll ends, poll() has something to do,
    // too; `wake` reports that.
    [[nodiscard]] SteadyTime next_time() const { return next_; }
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of the thread that rolls

  private:
    CacheRolled roll(const cache::Budgets& budgets);  // runs in its own thread
    void log(const CacheRolled& rolled, SteadyTime now);

    Sink& sink_;
    std::function<void()> wake_;
    Pulse pulse_;
    SteadyTime next_{}, next_reminder_{};
    std::optional<cache::StoreUsage> known_;
    // declared last, so that its destructor waits for the thread before the other members are
    // destroyed
    std::future<CacheRolled> roll_;
};

}  // namespace stormcellar::daemon
