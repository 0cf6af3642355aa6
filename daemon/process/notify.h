// daemon/process/notify.h -- what the service manager is told (sd_notify(3)), and its watchdog.
// Without a service manager all of it does nothing.
// Thread contract: one thread.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "base/steady_time.h"
#include "daemon/process/pulse.h"

namespace stormcellar::daemon {

class Notifier {
  public:
    Notifier() = default;
    Notifier(const Notifier&) = delete;
    Notifier& operator=(const Notifier&) = delete;
    virtual ~Notifier() = default;

    // Lines of VARIABLE=value.
    virtual void send(const std::string& state) = 0;
    // How long the manager waits for WATCHDOG=1 before it restarts us; none: it does not.
    [[nodiscard]] virtual std::optional<std::chrono::microseconds> watchdog() const = 0;
};

// Talks to $NOTIFY_SOCKET.
class SystemdNotifier final : public Notifier {
  public:
    void send(const std::string& state) override;
    [[nodiscard]] std::optional<std::chrono::microseconds> watchdog() const override;
};

// "RELOADING=1" with the monotonic time that systemd wants with it.
[[nodiscard]] std::string reloading_state();

// Decides when the watchdog is fed: four times a period, and only while no thread has been at one
// step (pulse.h) for longer than a whole period, so that a stuck one is not hidden by a loop that
// still turns. A step that lasts so long is logged, once, with or without a watchdog.
class WatchdogFeed {
  public:
    static constexpr std::chrono::seconds without_watchdog{180};

    explicit WatchdogFeed(std::optional<std::chrono::microseconds> period) : period_(period) {}
    [[nodiscard]] bool is_due(SteadyTime now, const std::optional<Step>& oldest);
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // Whether this step has just been found to last too long.
    [[nodiscard]] bool hangs_now(SteadyTime now, const std::optional<Step>& oldest);

  private:
    [[nodiscard]] bool hangs(SteadyTime now, const std::optional<Step>& oldest) const;

    std::optional<std::chrono::microseconds> period_;
    SteadyTime next_{};
    std::optional<SteadyTime> found_hanging_;  // since when the step lasted that was named
};

// Feeds when it is due, and logs what hangs.
void feed(WatchdogFeed& watchdog, Notifier& notifier, SteadyTime now,
          const std::optional<Step>& oldest);

}  // namespace stormcellar::daemon
