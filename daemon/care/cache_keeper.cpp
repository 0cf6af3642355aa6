#include "daemon/care/cache_keeper.h"

#include <algorithm>
#include <exception>
#include <system_error>

#include "base/byte_size.h"
#include "base/counted.h"
#include "base/printable.h"
#include "daemon/log/log.h"

namespace stormcellar::daemon {

std::optional<cache::StoreUsage> CacheKeeper::poll(SteadyTime now, const cache::Budgets& budgets) {
    std::optional<cache::StoreUsage> usage;
    if (roll_.valid()) {
        if (roll_.wait_for(std::chrono::seconds{0}) != std::future_status::ready) {
            // Wait at least a second. The roll calls `wake` when it ends.
            next_ = std::max(next_, now + std::chrono::seconds{1});
            return std::nullopt;
        }
        const CacheRolled rolled = roll_.get();
        log(rolled, now);
        if (rolled.usage && rolled.usage != known_) usage = known_ = rolled.usage;
    }
    if (now < next_) return usage;
    next_ = now + period;
    try {
        roll_ = std::async(std::launch::async, [this, budgets] { return roll(budgets); });
    } catch (const std::system_error& error) {  // the system has no thread left
        log_warning({Event::cache_problem}, "cannot check the limits of the cache: {}",
                    error.what());
    }
    return usage;
}

CacheRolled CacheKeeper::roll(const cache::Budgets& budgets) {
    CacheRolled rolled;
    try {
        const AtWork at_work(pulse_);
        rolled = sink_.roll_cache(budgets, [this] { pulse_.beat(); });
    } catch (const std::exception& error) {  // out of memory
        rolled.report.problems.emplace_back(error.what());
    }
    wake_();
    return rolled;
}

void CacheKeeper::log(const CacheRolled& rolled, SteadyTime now) {
    if (rolled.report.evicted > 0 && rolled.usage) {
        log_info({Event::cache_rolled},
                 "cache: evicted {} ({}) to keep its limits; it now holds {} ({})",
                 counted(static_cast<std::uint64_t>(rolled.report.evicted), "grid"),
                 format_byte_size(rolled.report.evicted_bytes),
                 counted(rolled.usage->grids, "grid"), format_byte_size(rolled.usage->bytes));
    }
    if (rolled.report.problems.empty()) {
        next_reminder_ = {};
    } else if (now >= next_reminder_) {
        next_reminder_ = now + reminder;
        for (const std::string& problem : rolled.report.problems)
            log_warning({Event::cache_problem}, "cache: {}", printable(problem));
    }
}

}  // namespace stormcellar::daemon
