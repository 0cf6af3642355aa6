#include "service/turns.h"

#include <csignal>

#include "service/log.h"

namespace stormcellar {
namespace {

constexpr std::chrono::milliseconds between_turns{1000};

}  // namespace

bool take_turns(const ServiceTurns& service, const Signals& signals, Notifier& notifier) {
    notifier.send("READY=1");
    WatchdogFeed watchdog(notifier.watchdog());
    for (;;) {
        service.turn();
        if (service.is_well() && watchdog.is_due(steady_now())) notifier.send("WATCHDOG=1");
        const auto signal = signals.next(between_turns);
        if (!signal) continue;
        if (*signal != SIGHUP) {
            say_stopping(*signal, notifier);
            return true;
        }
        const Reloading reloading(notifier);
        if (!service.reload()) return false;
    }
}

void say_stopping(int signal, Notifier& notifier) {
    say(LogLevel::info, "stopping: received {}", name_of_ending(signal));
    notifier.send("STOPPING=1");
}

}  // namespace stormcellar
