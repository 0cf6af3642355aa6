// level2/live_sweep.h -- a sweep that is handed out while its volume still arrives.
#pragma once

#include <cstddef>

#include "level2/volume.h"

namespace stormcellar::level2 {

struct LiveSweep {
    Sweep sweep;
    std::size_t index = 0;  // in the order of the volume, as far as it is known
    // From its first radial to its last none is missing. A sweep that is not whole comes again
    // when the chunks that it lacks have come.
    bool whole = false;
};

// Whether the sweep has its first radial and its last by their status, and all between them.
[[nodiscard]] bool is_whole(const Sweep& sweep);

}  // namespace stormcellar::level2
