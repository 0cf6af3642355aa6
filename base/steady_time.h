// base/steady_time.h -- instants of the monotonic clock, which nobody can set.
#pragma once

#include <chrono>

namespace stormcellar {

using SteadyTime = std::chrono::steady_clock::time_point;
[[nodiscard]] inline SteadyTime steady_now() {
    return std::chrono::steady_clock::now();
}

}  // namespace stormcellar
