// service/turns.h -- the main loop of a service whose work other threads do: a turn about once a
// second, reloads, the watchdog, and the end.
//
// Threads   One thread; the functions are called by it.
#pragma once

#include <chrono>
#include <functional>

#include "service/notify.h"
#include "service/signals.h"

namespace stormcellar {

struct ServiceTurns {
    std::function<void()> turn;
    // Returns true if the watchdog may be fed: the service makes progress.
    std::function<bool()> is_well;
    // Takes over the configuration. Returns false if the service cannot go on.
    std::function<bool()> reload;
};

// Reports READY, takes a turn each second and at each signal reloads or ends. Returns false if a
// reload failed for good; else true, after SIGTERM or SIGINT, which it logs (service/log.h).
[[nodiscard]] bool take_turns(const ServiceTurns& service, const Signals& signals,
                              Notifier& notifier);

// Logs the signal that ends the service and tells the manager.
void say_stopping(int signal, Notifier& notifier);

}  // namespace stormcellar
