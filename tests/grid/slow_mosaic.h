// tests/grid/slow_mosaic.h -- a slow and obvious form (oracle) of merging. It computes one cell at
// a time, in long doubles. For every site and column it computes a geodesic, and for every cell it
// lists what each site sees.
#pragma once

#include <span>
#include <vector>

#include "stormcellar/grid/mosaic.h"

namespace stormcellar::grid {

struct SlowCell {
    CellStatus status = CellStatus::not_seen;
    long double value = 0;
    int count = 0;
    long double weight = 0;
    // True if two weights or two distances that decide the state are nearly equal.
    bool is_close = false;
};

// Returns every cell, by the index of the domain's spec.
[[nodiscard]] std::vector<SlowCell> slow_mosaic(const GridSpec& domain,
                                                std::span<const Partial> partials,
                                                const MosaicOptions& options);

}  // namespace stormcellar::grid
