// daemon/process/notify.h -- tells the service manager how the service is (sd_notify(3)), and feeds
// its watchdog. Without a service manager all of it does nothing. Thread contract: one thread.
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
    // How long the manager waits for WATCHDOG=1 before it restarts the service; none: it does not.
    [[nodiscard]] virtual std::optional<std::chrono::microseconds> watchdog() const = 0;
};

// Talks to $NOTIFY_SOCKET.
class SystemdNotifier final : public Notifier {
  public:
    void send(const std::string& state) override;
    [[nodiscard]] std::optional<std::chrono::microseconds> watchdog() const override;
};

// "RELOADING=1", with the monotonic time that systemd requires.
[[nodiscard]] std::string reloading_state();

// Decides when the watchdog is fed: four times a period, and only while no thread has spent more
// than a whole period on one step (pulse.h). So a main loop that still turns does not hide a stuck
// thread. A step that takes so long is logged once, with or without a watchdog.
class WatchdogFeed {
  public:
    static constexpr std::chrono::seconds without_watchdog{180};

    explicit WatchdogFeed(std::optional<std::chrono::microseconds> period) : period_(period) {}
    [[nodiscard]] bool is_due(SteadyTime now, const std::optional<Step>& oldest);
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // Returns true if this step has just exceeded the limit.
    [[nodiscard]] bool hangs_now(SteadyTime now, const std::optional<Step>& oldest);

  private:
    [[nodiscard]] bool hangs(SteadyTime now, const std::optional<Step>& oldest) const;

    std::optional<std::chrono::microseconds> period_;
    SteadyTime next_{};
    std::optional<SteadyTime> found_hanging_;  // the start of the step that was last reported
};

// Feeds the watchdog when that is due, and logs what hangs.
void feed(WatchdogFeed& watchdog, Notifier& notifier, SteadyTime now,
          const std::optional<Step>& oldest);

}  // namespace stormcellar::daemon
