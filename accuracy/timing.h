// accuracy/timing.h -- measures how long work takes, in a way that is fair to all pieces.
//
// Units     Seconds.
// Threads   Runs the work on the calling thread.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace stormcellar::accuracy {

// Returns the seconds of a monotonic clock.
[[nodiscard]] double monotonic_s();
// Returns the processor seconds of the calling thread, which leave out other work of the machine.
[[nodiscard]] double thread_s();

struct Timing {
    double first_s = 0;   // the first run, which makes everything that later runs reuse
    double least_s = 0;   // of the later runs; the first run if there is no other
    double median_s = 0;  // of the same runs; for an even number, the mean of the middle two
};

// Runs each piece of work `rounds` times (0 counts as 1). Each round runs every piece once, one
// after the other, so that the load and the temperature of the machine affect all alike. Every
// other round goes backward, so that no piece always follows the same one. All first runs are in
// the first round.
[[nodiscard]] std::vector<Timing> time_in_rounds(
    std::span<const std::function<void()>> works, int rounds,
    const std::function<double()>& now_s = monotonic_s);

}  // namespace stormcellar::accuracy
