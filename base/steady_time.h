// base/steady_time.h -- instants of the monotonic clock, which nobody can set.
#pragma once

#include <chrono>

namespace stormcellar {

using SteadyTime = std::chrono::steady_clock::time_point;
[[nodiscard]] inline SteadyTime steady_now() {
    return std::chrono::steady_clock::now();
}

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
