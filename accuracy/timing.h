// accuracy/timing.h -- measures how long work takes, in a fair way.
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
// Returns the processor seconds of the calling thread, which leave out whatever else the machine
// does.
[[nodiscard]] double thread_s();

struct Timing {
    double first_s = 0;   // the first run, which makes everything that later runs keep
    double least_s = 0;   // of the later runs; the first run if there is no other
    double median_s = 0;  // of the same runs; for an even number the mean of the two in the middle
};

// Runs each piece of work `rounds` times (0 counts as 1). In each round every piece runs once, one
// after the other, so that the load and the temperature of the machine affect all alike. Every
// other round goes backward, so that no piece always follows the same one. All first runs are in
// the first round.
[[nodiscard]] std::vector<Timing> time_in_rounds(
    std::span<const std::function<void()>> works, int rounds,
    const std::function<double()>& now_s = monotonic_s);

}  // namespace stormcellar::accuracy
