// base/stopwatch.h -- measures how long something takes, with the monotonic clock.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>

namespace stormcellar {

[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Measures the seconds from one lap to the next.
class Stopwatch {
  public:
    double lap_s() {
        const double lap = seconds_since(last_);
        last_ = std::chrono::steady_clock::now();
        return lap;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace stormcellar
