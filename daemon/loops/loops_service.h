// daemon/loops/loops_service.h -- runs only the [[loop]] tables: `stormcellard --loops-only`.
//
// It is a service of its own, with a lower priority and its own limits, beside a stormcellard that
// was started with --no-loops. It reads no drop directory, catalog or grid itself; it runs the
// loops (daemon/loops/loop_supervisor.h) and publishes their state:
//   STATE/loops/status.json    {"state","pid","version","started","updated","loops"}, the fields as
//                              in daemon/status/status.h; at most once a second, and at the stop
//   STATE/loops/stormcellard.lock   held while it runs: one process runs the loops of a state
//   directory
// SIGHUP reads the configuration again: only the [[loop]] tables and the log level take effect. The
// watchdog is fed while no turn of the thread that runs the loops lasts too long. Thread contract:
// call run() once; any thread may call request_stop().
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/loops/loop_supervisor.h"
#include "daemon/process/notify.h"
#include "daemon/process/signals.h"
#include "daemon/process/wake_up.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::daemon {

class LoopsService {
  public:
    // All must outlive the object. Without signals only request_stop() ends it.
    struct Parts {
        Notifier& notifier;
        FileSystem& file_system;
        const Signals* signals = nullptr;
    };
    // SIGHUP reads `config_file` again.
    LoopsService(Config config, std::filesystem::path config_file, Parts parts);

    void run();
    void request_stop();

    // The directory that it writes to; it must exist.
    [[nodiscard]] static std::filesystem::path directory(const Config& config);

  private:
    void handle_signals();
    void reload();
    void publish(const char* state);
    void wait(SteadyTime now);

    Config config_;
    std::filesystem::path config_file_;
    Parts parts_;
    WatchdogFeed watchdog_;
    Pulses pulses_;
    UtcTime started_ = now_utc();
    std::vector<LoopState> loops_;
    bool has_news_ = false;
    bool failing_ = false;
    SteadyTime next_publish_{};
    std::atomic<bool> stop_requested_ = false;
    WakeUp wake_up_;
    LoopSupervisor keeper_;  // the last member: its thread uses the members above
};

}  // namespace stormcellar::daemon
