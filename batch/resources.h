// batch/resources.h -- the resources that a task requests from the engine.
//
// Units     Bytes and seconds.
// Threads   Pure functions.
// Errors    None.
// Accuracy  Generous upper bounds. `batch check` shows what tasks really used.
#pragma once

#include <cstddef>
#include <cstdint>

#include "batch/plan.h"

namespace stormcellar::batch {

struct Resources {
    std::uint64_t memory_bytes = 0;
    std::uint64_t scratch_bytes = 0;  // in the local scratch directory
    double seconds_a_task = 0;        // wall-clock time

    // Returns the time for this many tasks that run one after the other.
    [[nodiscard]] double seconds_of(std::size_t tasks) const;
};

[[nodiscard]] Resources resources_of_grids(const Plan& plan, int threads);
[[nodiscard]] Resources resources_of_frames(const Plan& plan, int threads);
[[nodiscard]] Resources resources_of_statistics(const Plan& plan);
// Returns the uncompressed size of the counts of all months and hours, or 0 without statistics.
[[nodiscard]] std::uint64_t bytes_of_counts(const Plan& plan);

}  // namespace stormcellar::batch
