// grid/beam/beam_pattern.h -- how much a gate counts for a point off its beam's axis.
//
// The one-way power pattern of the antenna, taken as a Gaussian of the half-power width: at half a
// width off the axis it is 1/2. It is cut off at `reach`, lowered by what it is there so that it
// ends at zero, and 1 on the axis:
//   weight(x) = (G(x) - G(reach)) / (1 - G(reach)),   G(x) = exp(-4 ln 2 (x / width)^2)
// width = reach = the larger of the beam width and the distance between neighbouring radials or
// sweeps, so that there are always two that count, and one alone on its own axis where they are
// no nearer to each other than the beam is wide.
// Source: the main lobe as a Gaussian, as Probert-Jones (1962) takes it. Accuracy: 1e-6
// (tests/grid/sweep_mixture_test.cpp).
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
