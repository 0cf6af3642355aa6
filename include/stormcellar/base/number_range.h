// stormcellar/base/number_range.h -- the allowed range of a numeric setting.
//
// A range is defined once, beside its setting (see render/scene.h), and both the check of the
// setting and the help text use it. Thread contract: pure functions.
#pragma once

namespace stormcellar {

// A range that includes both ends.
struct NumberRange {
    double least = 0;
    double most = 0;

    // Returns the range in a unit that is `unit` times as large: in(1000) turns meters into
    // kilometers.
    [[nodiscard]] constexpr NumberRange in(double unit) const {
        return {least / unit, most / unit};
    }
};

}  // namespace stormcellar
