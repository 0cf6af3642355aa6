// stormcellar/level2/live_sweep.h -- a sweep that is handed out while its volume still arrives.
#pragma once

#include <cstddef>
#include <cstdint>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct LiveSweep {
    Sweep sweep;
    // In the order of the volume, as far as it is known: no name for the sweep, since one that
    // comes late moves those behind it.
    std::size_t index = 0;
    // From its first radial to its last none is missing. A sweep that is not whole comes again
    // when the chunks that it lacks have come.
    bool whole = false;
};

// Sweeps of so many bytes, and one more, are handed out at once.
inline constexpr std::uint64_t most_live_bytes = std::uint64_t{64} << 20;
// Its arrays and radials, the allocator's share included.
[[nodiscard]] std::uint64_t bytes_of(const Sweep& sweep);

// Whether the sweep has its first radial and its last by their status, and all between them.
[[nodiscard]] bool is_whole(const Sweep& sweep);

}  // namespace stormcellar::level2
