#include "service/notify.h"

#include <cstdint>
#include <ctime>
#include <utility>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

namespace stormcellar {

// Ignores failures: if nothing arrives, timeouts of the service manager apply.
void SystemdNotifier::send(const std::string& state) {
    (void)sd_notify(0, state.c_str());
}

std::optional<std::chrono::microseconds> SystemdNotifier::watchdog() const {
    std::uint64_t period_us = 0;
    if (sd_watchdog_enabled(0, &period_us) <= 0) return std::nullopt;
    return std::chrono::microseconds{period_us};
}

std::string reloading_state() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return fmt::format("RELOADING=1\nMONOTONIC_USEC={}",
                       std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000);
}

Reloading::Reloading(Notifier& notifier) : notifier_(notifier) {
    notifier_.send(reloading_state());
}

Reloading::~Reloading() {
    notifier_.send("READY=1");
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

}  // namespace stormcellar
