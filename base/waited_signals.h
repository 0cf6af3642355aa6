// base/waited_signals.h -- signals as something to wait for instead of interruptions.
//
// Make one object before any thread starts: it blocks SIGTERM, SIGINT and SIGHUP for this thread
// and the threads that it starts, and ignores SIGPIPE. A signal that arrives waits for next().
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <optional>

#include <signal.h>

namespace stormcellar {

class WaitedSignals {
  public:
    WaitedSignals();
    // Waits for a signal and returns its number; none if none comes within this time.
    [[nodiscard]] std::optional<int> next(std::chrono::milliseconds most) const;

  private:
    sigset_t set_{};
};

}  // namespace stormcellar
