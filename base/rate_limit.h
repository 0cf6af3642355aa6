// base/rate_limit.h -- limits how many lines of one kind a service logs.
//
// Threads   Plain data: one thread at a time, or under a lock. The caller passes the current time.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "base/steady_time.h"

namespace stormcellar {

// Lets `most` lines through in each period, and counts further lines as held back. If lines were
// held back, the next period begins only when take_held_back() has returned their number.
class RateLimit {
  public:
    RateLimit(int most, std::chrono::seconds period) : most_(most), period_(period) {}
    // Returns true if a line may be logged now; otherwise the line counts as held back.
    bool allow(SteadyTime now);
    // Returns how many lines were held back in the period, if the period is over. Returns none
    // during the period, if no lines were held back, or if their number was returned before.
    std::optional<std::uint64_t> take_held_back(SteadyTime now);
    // Returns true if this object may be deleted: its period is over, and it has no lines to
    // report.
    [[nodiscard]] bool is_idle(SteadyTime now) const {
        return held_back_ == 0 && now - began_ >= period_;
    }

  private:
    int most_;
    std::chrono::seconds period_;
    SteadyTime began_{};
    int used_ = 0;
    std::uint64_t held_back_ = 0;
};

}  // namespace stormcellar
