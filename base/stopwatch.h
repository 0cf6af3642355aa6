// base/stopwatch.h -- measures how long something takes, with the monotonic clock.
//
// Threads   One thread at a time.
#pragma once

#include "base/steady_time.h"

namespace stormcellar {

[[nodiscard]] inline double seconds_since(SteadyTime start) {
    return std::chrono::duration<double>(steady_now() - start).count();
}

// Measures the seconds from one lap to the next.
class Stopwatch {
  public:
    double lap_s() {
        const double lap = seconds_since(last_);
        last_ = steady_now();
        return lap;
    }

  private:
    SteadyTime last_ = steady_now();
};

}  // namespace stormcellar
