#include "daemon/process/notify.h"

#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include "base/printable.h"
#include "daemon/log/log.h"

namespace stormcellar::daemon {

// A failure is ignored: the service manager's own timeouts react to silence.
void SystemdNotifier::send(const std::string& state) {
    (void)sd_notify(0, state.c_str());
}

std::optional<std::chrono::microseconds> SystemdNotifier::watchdog() const {
    std::uint64_t period_us = 0;
    if (sd_watchdog_enabled(0, &period_us) <= 0) return std::nullopt;
    return std::chrono::microseconds{period_us};
}

bool WatchdogFeed::hangs(SteadyTime now, const std::optional<Step>& oldest) const {
    return oldest && now - oldest->since > period_.value_or(without_watchdog);
}

bool WatchdogFeed::is_due(SteadyTime now, const std::optional<Step>& oldest) {
    if (!period_ || now < next_) return false;
    next_ = now + *period_ / 4;
    return !hangs(now, oldest);
}

bool WatchdogFeed::hangs_now(SteadyTime now, const std::optional<Step>& oldest) {
    if (!hangs(now, oldest)) return false;
    return std::exchange(found_hanging_, oldest->since) != oldest->since;
}

std::optional<SteadyTime> WatchdogFeed::next_time() const {
    if (!period_) return std::nullopt;
    return next_;
}

void feed(WatchdogFeed& watchdog, Notifier& notifier, SteadyTime now,
          const std::optional<Step>& oldest) {
    if (watchdog.is_due(now, oldest)) notifier.send("WATCHDOG=1");
    if (!watchdog.hangs_now(now, oldest)) return;
    log_error({Event::hang},
              "hang: {} has been at one step for {} s; the watchdog is not fed until it goes on, "
              "so systemd may restart the service",
              printable(oldest->who),
              std::chrono::duration_cast<std::chrono::seconds>(now - oldest->since).count());
}

}  // namespace stormcellar::daemon
