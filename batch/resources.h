// batch/resources.h -- what a task needs of a machine, as stated to the engine.
//
// Units     Bytes and seconds.
// Threads   Pure functions.
// Errors    None.
// Accuracy  Upper bounds with room. `batch check` shows what tasks took.
#pragma once

#include <cstddef>
#include <cstdint>

#include "batch/plan.h"

namespace stormcellar::batch {

struct Resources {
    std::uint64_t memory_bytes = 0;
    std::uint64_t scratch_bytes = 0;  // in the local scratch directory
    double seconds_a_task = 0;        // by the clock

    // Returns the time for tasks that run one after the other.
    [[nodiscard]] double seconds_of(std::size_t tasks) const;
};

[[nodiscard]] Resources resources_of_grids(const Plan& plan, int threads);
[[nodiscard]] Resources resources_of_frames(const Plan& plan, int threads);
[[nodiscard]] Resources resources_of_statistics(const Plan& plan);
// Returns what the counts of all months and hours take before they are compressed; 0 without
// statistics.
[[nodiscard]] std::uint64_t bytes_of_counts(const Plan& plan);

}  // namespace stormcellar::batch
