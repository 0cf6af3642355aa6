// tests/daemon/steady_start.h -- the steady time at which tests with a simulated clock begin.
#pragma once

#include <chrono>

#include "daemon/queue/schedule.h"

namespace stormcellar::daemon {

inline constexpr SteadyTime t0 = SteadyTime{} + std::chrono::hours{1};

}  // namespace stormcellar::daemon
