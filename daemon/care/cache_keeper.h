// daemon/care/cache_keeper.h -- has the cache kept within its budgets while the service runs.
//
// Every 5 seconds, so that the file system's filling is met within 10, and in a thread of its own:
// a roll may remove thousands of files. Logs what went, and what keeps the budgets from being kept
// (at once, then again every 10 minutes while it lasts).
// Thread contract: one thread; `wake` is called from the roll's and must only signal.
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

    // Takes what a roll found, when one has ended, and starts the next when it is due. What the
    // cache holds, when that is news.
    std::optional<cache::StoreUsage> poll(SteadyTime now, const cache::Budgets& budgets);
    void roll_soon() { next_ = {}; }  // the budgets have changed
    // When the next roll is due. A roll that lasts longer delays it.
    [[nodiscard]] SteadyTime next_time() const { return next_; }
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of the roll's thread

  private:
    CacheRolled roll(const cache::Budgets& budgets);  // in its own thread
    void log(const CacheRolled& rolled, SteadyTime now);

    Sink& sink_;
    std::function<void()> wake_;
    Pulse pulse_;
    SteadyTime next_{}, next_reminder_{};
    std::optional<cache::StoreUsage> known_;
    std::future<CacheRolled> roll_;  // the last member: waited for before the rest goes
};

}  // namespace stormcellar::daemon
