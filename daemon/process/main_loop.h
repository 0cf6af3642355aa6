// daemon/process/main_loop.h -- what the main loops of the threads share: they sleep, take signals
// and feed the watchdog.
//
// Threads   One thread at a time.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include <poll.h>

#include "base/steady_time.h"
#include "service/notify.h"
#include "service/signals.h"

namespace stormcellar::daemon {

// Takes all pending signals and calls `reload` for each SIGHUP. Returns true if one of them asked
// for the end, which is logged. With a null `signals` it does nothing.
[[nodiscard]] bool take_signals(const Signals* signals, const std::function<void()>& reload);

// Sleeps until a descriptor is ready, at most until `until`. An interrupted sleep is only short;
// negative descriptors are ignored.
void poll_until(std::span<pollfd> sources, SteadyTime now, SteadyTime until);

// Feeds the watchdog if it is due, and logs a thread that hangs.
void feed(WatchdogFeed& watchdog, Notifier& notifier, SteadyTime now,
          const std::optional<Step>& oldest);

}  // namespace stormcellar::daemon
