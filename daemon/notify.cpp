#include "daemon/notify.h"

#include <cstdint>
#include <ctime>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

namespace stormcellar::daemon {

// A failure to tell is no reason to stop: the manager's own timeouts act on silence.
void SystemdNotifier::send(const std::string& state) {
    (void)sd_notify(0, state.c_str());
}

std::optional<std::chrono::microseconds> SystemdNotifier::watchdog() const {
    std::uint64_t period_us = 0;
    if (sd_watchdog_enabled(0, &period_us) <= 0) return std::nullopt;
    return std::chrono::microseconds{period_us};
}

std::string reloading_state() {
    struct timespec now {};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return fmt::format("RELOADING=1\nMONOTONIC_USEC={}",
                       std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000);
}

bool WatchdogFeed::is_due(SteadyTime now, std::optional<SteadyTime> oldest_job_start) {
    if (!period_ || now < next_) return false;
    next_ = now + *period_ / 4;
    return !oldest_job_start || now - *oldest_job_start <= *period_;
}

std::optional<SteadyTime> WatchdogFeed::next_time() const {
    if (!period_) return std::nullopt;
    return next_;
}

}  // namespace stormcellar::daemon
