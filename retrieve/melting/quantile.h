// retrieve/melting/quantile.h -- returns a quantile of some values.
//
// Threads   A pure function.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stormcellar::retrieve {

// Returns the value at a share from 0 to less than 1 of the sorted values, without interpolation.
// There must be at least one value.
[[nodiscard]] inline double quantile(std::vector<double> values, double share = 0.5) {
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace stormcellar::retrieve
