// grid/beam/beam_pattern.h -- how much a gate counts for a point off the axis of its beam.
//
// The weight is the one-way power pattern of the antenna, taken as a Gaussian of the half-power
// width: half a width off the axis it is 1/2. It is cut off at `reach`. So that it ends at zero
// there and is still 1 on the axis, it is lowered and scaled:
//   weight(x) = (G(x) - G(reach)) / (1 - G(reach)),   G(x) = exp(-4 ln 2 (x / width)^2)
// Here width = reach = the larger of the beam width and the distance between neighboring radials or
// sweeps. So there are always two that count; on the axis of one, that one alone counts, unless the
// others are nearer than the width of the beam.
//
// Source    Probert-Jones (1962), who takes the main lobe as a Gaussian.
// Accuracy  1e-6 (tests/grid/sweep_mixture_test.cpp).
// Threads   A pure function.
#pragma once

#include <cmath>

namespace stormcellar::grid {

[[nodiscard]] inline float beam_pattern(float offset, float width) {
    constexpr float four_ln2 = 2.7725887F;
    constexpr float at_reach = 0.0625F;  // G(width) = 2^-4
    const float ratio = offset / width;
    if (!(ratio > -1 && ratio < 1)) return 0;
    return (std::exp(-four_ln2 * ratio * ratio) - at_reach) / (1 - at_reach);
}

}  // namespace stormcellar::grid
