// base/rate_limit.h -- limits how many lines of one kind a service logs.
//
// Threads   Plain data: one thread at a time, or under a lock. The caller passes the current time.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "base/steady_time.h"

namespace stormcellar {

// Lets `most` lines through in each period and counts the rest.
class RateLimit {
  public:
    RateLimit(int most, std::chrono::seconds period) : most_(most), period_(period) {}
    // Returns true if the line may be logged.
    bool allow(SteadyTime now);
    // Returns how many lines were held back once their period is over, and starts again from zero.
    std::optional<std::uint64_t> take_held_back(SteadyTime now);
    // Returns true if it may be deleted: its period is over and it holds no lines back.
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
