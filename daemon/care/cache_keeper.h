// daemon/care/cache_keeper.h -- keeps the cache within its limits while the service runs.
//
// Checks the cache every 5 seconds, so that it reacts within 10 seconds when the file system fills.
// A roll may remove thousands of files, so it runs in its own thread. Logs how much was evicted,
// and what prevents keeping the limits (at once, then every 10 minutes while it lasts). Thread
// contract: one thread. `wake` is called from the thread of the roll, and must only signal.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <utility>

#include "base/steady_time.h"
#include "daemon/process/pulse.h"
#include "daemon/queue/sink.h"

namespace stormcellar::daemon {

class CacheKeeper {
  public:
    static constexpr std::chrono::seconds period{5};
    static constexpr std::chrono::minutes reminder{10};

    CacheKeeper(Sink& sink, std::function<void()> wake) : sink_(sink), wake_(std::move(wake)) {}

    // Collects the result of a roll that has ended, and starts the next roll when it is due.
    // Returns what the cache holds if that has changed.
    std::optional<cache::StoreUsage> poll(SteadyTime now, const cache::Budgets& budgets);
    void roll_soon() { next_ = {}; }  // the budgets have changed
    // When the next roll is due. A roll that takes longer delays it.
    [[nodiscard]] SteadyTime next_time() const { return next_; }
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of the roll's thread

  private:
    CacheRolled roll(const cache::Budgets& budgets);  // runs in its own thread
    void log(const CacheRolled& rolled, SteadyTime now);

    Sink& sink_;
    std::function<void()> wake_;
    Pulse pulse_;
    SteadyTime next_{}, next_reminder_{};
    std::optional<cache::StoreUsage> known_;
    std::future<CacheRolled>
        roll_;  // the last member: its destructor waits before the others are destroyed
};

}  // namespace stormcellar::daemon
