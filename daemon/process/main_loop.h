// daemon/process/main_loop.h -- functions with which main loops take signals, sleep, and feed the
// watchdog.
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

// Takes all pending signals and calls `reload` for each SIGHUP. Every other signal asks the service
// to end; for such a signal, writes a log line and returns true. Returns false if `signals` is
// null.
[[nodiscard]] bool take_signals(const Signals* signals, const std::function<void()>& reload);

// Sleeps until a descriptor is ready, the time `until` has come, or a signal arrives. Ignores
// negative descriptors.
void poll_until(std::span<pollfd> sources, SteadyTime now, SteadyTime until);

// Feeds the watchdog if that is due. If the oldest step has lasted too long, does not feed it, and
// logs once that the step hangs.
void feed(WatchdogFeed& watchdog, Notifier& notifier, SteadyTime now,
          const std::optional<Step>& oldest);

}  // namespace stormcellar::daemon
