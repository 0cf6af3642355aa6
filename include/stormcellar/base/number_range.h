// stormcellar/base/number_range.h -- the allowed range of a numeric setting.
//
// A range is stated once, beside its setting. Both the check of the setting and the help text use
// it (render/scene.h has an example).
// Thread contract: pure functions.
#pragma once

namespace stormcellar {

// Both ends are inside the range.
struct NumberRange {
    double least = 0;
    double most = 0;

    // Returns the same range in a unit that is this many times as large: meters in(1000) are
    // kilometers.
    [[nodiscard]] constexpr NumberRange in(double unit) const {
        return {least / unit, most / unit};
    }
};

}  // namespace stormcellar
