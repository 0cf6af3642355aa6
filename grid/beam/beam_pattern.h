// grid/beam/beam_pattern.h -- computes how much a gate counts for a point off the axis of its beam.
//
// The weight follows the one-way power pattern of the antenna. The pattern is a Gaussian, which is
// 1/2 at half of the half-power width off the axis. The pattern is shifted and scaled, so that the
// weight is 1 on the axis and 0 from `reach` on:
//   weight(x) = (G(x) - G(reach)) / (1 - G(reach)),   G(x) = exp(-4 ln 2 (x / width)^2)
// Here width = reach = the larger of the beam width and the distance between neighboring radials or
// sweeps. So a point between two neighboring radials or sweeps gets weight from both. A point on
// the axis of a radial or sweep gets weight from this radial or sweep alone, unless the neighbors
// are nearer than the beam width.
//
// Source    Probert-Jones (1962), who treats the main lobe as a Gaussian.
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
