// daemon/log.h -- where log lines go, and how many of a kind.
//
// To stderr: with time and level for people; with syslog's "<N>" level prefix when stderr is the
// journal (JOURNAL_STREAM names it), which adds the time itself. Lines are logged with spdlog's own
// functions; whoever logs a name from outside passes it through printable().
// Thread contract: set_up_logging() before other threads start; a RateLimit belongs to one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/schedule.h"

namespace stormcellar::daemon {

// `level` is one of debug, info, warning, error.
void set_up_logging(const std::string& level);
void set_log_level(const std::string& level);

// True when stderr is the stream that JOURNAL_STREAM=device:inode names.
[[nodiscard]] bool stderr_is_journal();

// Lets `most` lines through in each period and counts the rest.
class RateLimit {
  public:
    RateLimit(int most, std::chrono::seconds period) : most_(most), period_(period) {}
    // True when the line may be logged.
    bool allow(SteadyTime now);
    // How many lines were held back, once their period is over; then it counts from zero again.
    std::optional<std::uint64_t> take_held_back(SteadyTime now);

  private:
    int most_;
    std::chrono::seconds period_;
    SteadyTime began_{};
    int used_ = 0;
    std::uint64_t held_back_ = 0;
};

}  // namespace stormcellar::daemon
