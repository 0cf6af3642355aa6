// service/notify.h -- reports the state of a service to its service manager (sd_notify(3)), and
// feeds the watchdog. Does nothing if there is no service manager.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "base/steady_time.h"
#include "service/pulse.h"
#include "stormcellar/base/interface.h"

namespace stormcellar {

class Notifier : public Interface {
  public:
    // Reports a state, which has lines of the form VARIABLE=value.
    virtual void send(const std::string& state) = 0;
    // Returns how long the manager waits for WATCHDOG=1 before it restarts the service. Returns
    // none if the manager does not watch the service.
    [[nodiscard]] virtual std::optional<std::chrono::microseconds> watchdog() const = 0;
};

// Sends to the socket that $NOTIFY_SOCKET names. Does nothing if the variable is not set.
class SystemdNotifier final : public Notifier {
  public:
    void send(const std::string& state) override;
    [[nodiscard]] std::optional<std::chrono::microseconds> watchdog() const override;
};

// Reports that the service reloads its configuration. The destructor reports READY=1 again.
class Reloading {
  public:
    explicit Reloading(Notifier& notifier);
    Reloading(const Reloading&) = delete;
    Reloading& operator=(const Reloading&) = delete;
    ~Reloading();

  private:
    Notifier& notifier_;
};

// Returns the text "RELOADING=1" with the monotonic time that systemd requires (sd_notify(3)).
[[nodiscard]] std::string reloading_state();

// Decides when to feed the watchdog: four times in each period of the watchdog, but only while no
// thread has been at one step (pulse.h) for longer than a whole period. So a hanging thread is
// noticed even if the main loop still runs. Each step that hangs is reported once. If there is no
// watchdog, a step hangs after `without_watchdog`.
class WatchdogFeed {
  public:
    static constexpr std::chrono::seconds without_watchdog{180};

    explicit WatchdogFeed(std::optional<std::chrono::microseconds> period) : period_(period) {}
    [[nodiscard]] bool is_due(SteadyTime now, const std::optional<Step>& oldest = std::nullopt);
    [[nodiscard]] std::optional<SteadyTime> next_time() const;
    // Returns true if the step hangs and was not reported before.
    [[nodiscard]] bool hangs_now(SteadyTime now, const std::optional<Step>& oldest);

  private:
    [[nodiscard]] bool hangs(SteadyTime now, const std::optional<Step>& oldest) const;

    std::optional<std::chrono::microseconds> period_;
    SteadyTime next_{};
    std::optional<SteadyTime> found_hanging_;  // the start of the step that was reported
};

}  // namespace stormcellar
