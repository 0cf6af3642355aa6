// grid/cells/nearest_code.h -- rounds a value to a code.
//
// Threads   Pure function.
#pragma once

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::grid {

// Returns the code nearest to a value. The code is a whole number, which may be outside the range
// of codes.
[[nodiscard]] inline double nearest_code(float value, const Quantization& quantization) {
    const double steps =
        (static_cast<double>(value) - static_cast<double>(quantization.first_value)) /
        static_cast<double>(quantization.step);
    // Adding 2^52 rounds to the nearest whole number (halves to even), because a double above 2^52
    // has no fraction.
    constexpr double no_fraction = 0x1.8p52;
    return steps + no_fraction - no_fraction + first_value_code;
}

}  // namespace stormcellar::grid
