// tests/testing/waiting.h -- the one place where tests wait.
//
// A test waits for a condition, with an end, and never for a time: a fixed wait is too long on most
// machines, and on a slow one it proves nothing. To show that nothing happened, a test waits for
// something that comes later in the same queue, or for a counter of turns.
// tests/repository/waits_test.cpp holds this: no other file of the tests sleeps.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace stormcellar::testing {

// Lets time pass in a load or a simulated peer: a load has a rate, a kill comes at a random moment.
// It proves nothing, so no test may wait for somebody else this way; the repository's test lists
// the files that call it.
inline void pass_time(std::chrono::nanoseconds time) {
    std::this_thread::sleep_for(time);
}

// Asks again and again, first after a millisecond and later every 10 ms, until the condition holds,
// at most for `limit`. Returns what it said last.
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
