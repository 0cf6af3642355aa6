// stormcellar/level2/live_sweep.h -- a sweep that is handed out while its volume still arrives.
//
// Units     Sizes are in bytes.
// Threads   Plain data and pure functions.
// Errors    None.
#pragma once

#include <cstddef>
#include <cstdint>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct LiveSweep {
    Sweep sweep;
    // The index in the volume as far as it is known. It does not name the sweep, because a late
    // sweep moves those after it.
    std::size_t index = 0;
    // True if no radial is missing from the first to the last. A sweep that is not whole is handed
    // out again when the missing chunks have come.
    bool whole = false;
};

// Sweeps are handed out until they exceed this size; the last may go beyond it.
inline constexpr std::uint64_t most_live_bytes = std::uint64_t{64} << 20;
// Returns the bytes of its arrays and radials, including the share of the allocator.
[[nodiscard]] std::uint64_t bytes_of(const Sweep& sweep);

// Returns true if the status of its radials marks the first and the last, and none is missing or
// repeated in between.
[[nodiscard]] bool is_whole(const Sweep& sweep);

}  // namespace stormcellar::level2
