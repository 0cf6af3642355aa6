// accuracy/timing.h -- measures how long pieces of work take, in equal conditions.
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
// Returns the processor time of the calling thread in seconds. Other threads and programs do not
// add to this time.
[[nodiscard]] double thread_s();

struct Timing {
    double first_s = 0;  // the first run, which also prepares what later runs reuse
    double least_s = 0;  // the fastest later run, or the first run if there is only one
    // Median of the later runs, or the first run if there is only one. For an even number of runs,
    // the mean of the middle two.
    double median_s = 0;
};

// Runs each piece of work `rounds` times (0 counts as 1). Each round runs every piece once, so that
// the load and the temperature of the machine affect all pieces alike. Every second round runs the
// pieces in reverse order, so that no piece always follows the same other piece.
[[nodiscard]] std::vector<Timing> time_in_rounds(
    std::span<const std::function<void()>> works, int rounds,
    const std::function<double()>& now_s = monotonic_s);

}  // namespace stormcellar::accuracy
