// service/turns.h -- the main loop of a service whose work other threads do. Each second, the loop
// calls ServiceTurns::turn. It also reloads, feeds the watchdog, and ends the service.
//
// Threads   One thread, which calls all functions.
#pragma once

#include <chrono>
#include <functional>

#include "service/notify.h"
#include "service/signals.h"

namespace stormcellar {

struct ServiceTurns {
    std::function<void()> turn;  // does the regular work
    // Returns true if the service makes progress, so that the watchdog may be fed.
    std::function<bool()> is_well;
    // Applies the new configuration. Returns false if the service cannot go on.
    std::function<bool()> reload;
};

// Reports READY and calls `turn` each second. On SIGHUP, reloads, and returns false if the service
// cannot go on after that. On SIGTERM or SIGINT, logs the signal (service/log.h) and returns true.
[[nodiscard]] bool take_turns(const ServiceTurns& service, const Signals& signals,
                              Notifier& notifier);

// Logs the signal that ends the service, and reports the end to the service manager.
void say_stopping(int signal, Notifier& notifier);

}  // namespace stormcellar
