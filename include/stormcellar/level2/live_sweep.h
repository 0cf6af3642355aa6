// stormcellar/level2/live_sweep.h -- a sweep that is returned while its volume still arrives.
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
    // The index in the volume when the sweep was returned. The index does not identify the sweep,
    // because a late sweep shifts the sweeps after it.
    std::size_t index = 0;
    // True if no radial is missing from the first to the last. A sweep that is not whole is
    // returned again when missing radials come.
    bool whole = false;
};

// take_sweeps() stops adding sweeps once those that it returns reach this size together. Later
// calls return the rest.
inline constexpr std::uint64_t most_live_bytes = std::uint64_t{64} << 20;
// Returns the bytes of the sweep's arrays and radials, including an estimate of the allocator's
// overhead.
[[nodiscard]] std::uint64_t bytes_of(const Sweep& sweep);

// Returns true if the status of the first radial marks the start of the sweep, the status of the
// last radial marks its end, and no radial between them is missing or repeated.
[[nodiscard]] bool is_whole(const Sweep& sweep);

}  // namespace stormcellar::level2
