// daemon/loops/loops_service.h -- a service that only runs the loops of the [[loop]] tables:
// `stormcellard --loops-only`.
//
// The service runs beside a stormcellard that was started with --no-loops. The service has a lower
// priority, and limits of its own. It reads neither the drop directory nor the catalog nor grids.
// It runs the loops (daemon/loops/loop_supervisor.h) and publishes their state:
//   STATE/loops/status.json        {"state","pid","version","started","updated","loops"}, the
//                                  fields as in daemon/status/status.h; written at most once a
//                                  second, and at the end
//   STATE/loops/stormcellard.lock  locked while the service runs, so that a state directory has
//                                  only one keeper of loops
// On SIGHUP the service reads the configuration again, and applies only the [[loop]] tables and the
// log level. It feeds the watchdog unless a turn of the supervisor's thread takes too long.
//
// Threads   Call run() once; request_stop() may be called from any thread.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/loops/loop_supervisor.h"
#include "daemon/process/main_loop.h"
#include "daemon/process/wake_up.h"
#include "daemon/status/status_file.h"
#include "service/notify.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::daemon {

class LoopsService {
  public:
    // All of these must outlive the service. Without `signals`, only request_stop() ends the
    // service.
    struct Parts {
        Notifier& notifier;
        FileSystem& file_system;
        const Signals* signals = nullptr;
    };
    // `config_file` is read again on SIGHUP.
    LoopsService(Config config, std::filesystem::path config_file, Parts parts);

    void run();
    void request_stop();

    // Returns the directory in which the service writes. The caller must make it.
    [[nodiscard]] static std::filesystem::path directory(const Config& config);

  private:
    void handle_signals();
    void reload();
    // Publishes changes at most once a second, or at once if `force` is set.
    void publish(const char* state, bool force);
    void wait(SteadyTime now);

    Config config_;
    std::filesystem::path config_file_;
    Parts parts_;
    WatchdogFeed watchdog_;
    Pulses pulses_;
    UtcTime started_ = now_utc();
    std::vector<LoopState> loops_;
    StatusFile status_file_;
    std::atomic<bool> stop_requested_ = false;
    WakeUp wake_up_;
    LoopSupervisor keeper_;  // the last member: its thread uses the members above
};

}  // namespace stormcellar::daemon
