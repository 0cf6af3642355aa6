// tests/render/against_reference.h -- compares a layer with the reference, which marches along each
// ray in small steps.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/volume/reference_marcher.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {

struct RayDifference {
    double rms = 0, worst = 0;
};

// Compares every `stride`-th pixel in both directions, from `first` on.
inline RayDifference against_reference(const ReferenceMarcher& reference, const Layer& layer,
                                       int steps, int first, int stride) {
    RayDifference difference;
    int count = 0;
    for (int y = first; y < layer.height; y += stride) {
        for (int x = first; x < layer.width; x += stride) {
            const auto slow = reference.ray({x + 0.5, y + 0.5}, steps);
            const auto fast = pixel_of(layer, x, y);
            for (std::size_t c = 0; c < 4; ++c) {
                const double off = std::abs(slow[c] - fast[c]);
                difference.rms += off * off;
                difference.worst = std::max(difference.worst, off);
                ++count;
            }
        }
    }
    difference.rms = std::sqrt(difference.rms / count);
    return difference;
}

}  // namespace stormcellar::render
