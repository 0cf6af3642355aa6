// accuracy/timing.h -- how long work takes, fairly.
//
// Thread contract: runs the work on the calling thread.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace stormcellar::accuracy {

// Seconds of a monotonic clock.
[[nodiscard]] double monotonic_s();
// Seconds of the processor that the calling thread has had: what else the machine does is not in
// it.
[[nodiscard]] double thread_s();

struct Timing {
    double first_s = 0;   // the first run, with all that it makes and later ones keep
    double least_s = 0;   // of the later runs; the first when there is no other
    double median_s = 0;  // likewise; of an even number the mean of the two in the middle
};

// Runs each piece of work `rounds` times (0 counts as 1), in rounds: each once, one behind the
// other, so that what else the machine does and how warm it is falls on all alike; every other
// round backwards, so that none is always behind the same. First runs are all in the first round.
[[nodiscard]] std::vector<Timing> time_in_rounds(
    std::span<const std::function<void()>> works, int rounds,
    const std::function<double()>& now_s = monotonic_s);

}  // namespace stormcellar::accuracy
