// tests/testing/waiting.h -- waits for conditions in tests.
//
// A test waits for a condition, with a limit, and never for a fixed time. A fixed time would be too
// long on most machines and too short on a slow machine. To show that nothing happened, a test
// waits for something that comes later in the same queue, or for a counter of turns.
// tests/repository/waits_test.cpp checks that no other file of the tests sleeps.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace stormcellar::testing {

// Sleeps, for a load with a rate, a simulated peer or a kill at a random moment. A sleep proves
// nothing, so no test may wait this way for another program or thread; waits_test.cpp lists the
// files that may call pass_time().
inline void pass_time(std::chrono::nanoseconds time) {
    std::this_thread::sleep_for(time);
}

// Checks the condition repeatedly, first after a millisecond and later every 10 ms, until the
// condition is true or `limit` has passed. Returns the last value of the condition.
template <class Condition>
[[nodiscard]] bool eventually(const Condition& holds,
                              std::chrono::nanoseconds limit = std::chrono::minutes{1}) {
    constexpr std::chrono::milliseconds first_pause{1}, longest_pause{10};
    const auto end = std::chrono::steady_clock::now() + limit;
    for (auto pause = first_pause; !holds(); pause = std::min(2 * pause, longest_pause)) {
        if (std::chrono::steady_clock::now() >= end) return holds();
        pass_time(pause);
    }
    return true;
}

}  // namespace stormcellar::testing
