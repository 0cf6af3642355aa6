// cli/stopwatch.h -- seconds from one lap to the next.
#pragma once

#include <chrono>

namespace stormcellar::cli {

class Stopwatch {
  public:
    double lap_s() {
        const auto now = Clock::now();
        const std::chrono::duration<double> lap = now - last_;
        last_ = now;
        return lap.count();
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point last_ = Clock::now();
};

}  // namespace stormcellar::cli
