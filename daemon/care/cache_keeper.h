// daemon/care/cache_keeper.h -- keeps the cache within its budgets while the service runs.
//
// The cache is rolled every 5 seconds, so that a file system that fills up is noticed within 10. A
// roll may remove thousands of files, so it runs in a thread of its own. It logs what was removed
// and what keeps the budgets from being met (at once, then every 10 minutes while it lasts).
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

    // Takes the result of a roll that has ended, and starts the next one if it is due. Returns what
    // the cache holds if that has changed.
    std::optional<cache::StoreUsage> poll(SteadyTime now, const cache::Budgets& budgets);
    void roll_soon() { next_ = {}; }  // call when the budgets have changed
    // Returns when the next roll is due. A roll that takes longer delays it.
    [[nodiscard]] SteadyTime next_time() const { return next_; }
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of the thread of the roll

  private:
    CacheRolled roll(const cache::Budgets& budgets);  // runs in its own thread
    void log(const CacheRolled& rolled, SteadyTime now);

    Sink& sink_;
    std::function<void()> wake_;
    Pulse pulse_;
    SteadyTime next_{}, next_reminder_{};
    std::optional<cache::StoreUsage> known_;
    // declared last, so that its destructor waits for the thread before the others are destroyed
    std::future<CacheRolled> roll_;
};

}  // namespace stormcellar::daemon
