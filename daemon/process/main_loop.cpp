#include "daemon/process/main_loop.h"

#include <algorithm>
#include <csignal>
#include <cstdint>

#include "base/printable.h"
#include "daemon/log/log.h"

namespace stormcellar::daemon {

bool take_signals(const Signals* signals, const std::function<void()>& reload) {
    if (signals == nullptr) return false;
    bool is_asked_to_end = false;
    while (const std::optional<int> signal = signals->next()) {
        if (*signal == SIGHUP) {
            reload();
            continue;
        }
        log_info({Event::stopping}, "stopping: received {}", name_of_ending(*signal));
        is_asked_to_end = true;
    }
    return is_asked_to_end;
}

void poll_until(std::span<pollfd> sources, SteadyTime now, SteadyTime until) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - now);
    ::poll(sources.data(), sources.size(),
           static_cast<int>(std::max<std::int64_t>(0, left.count())));
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
