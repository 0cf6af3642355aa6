// stormcellar/base/number_range.h -- the numbers that a setting may be.
//
// A range is stated once, beside the setting that it is for. What checks the setting, and what
// prints the range for a user, both take it from there (render/scene.h has an example).
// Thread contract: pure functions.
#pragma once

namespace stormcellar {

// Both ends are inside the range.
struct NumberRange {
    double least = 0;
    double most = 0;

    // The same range in a unit that is so many times as large: meters in(1000) are kilometers.
    [[nodiscard]] constexpr NumberRange in(double unit) const {
        return {least / unit, most / unit};
    }
};

}  // namespace stormcellar
