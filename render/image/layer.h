// render/image/layer.h -- a picture that one sees through, and how it is laid over another.
//
// SIMD by Highway; the same bits on every target and for any number of threads.
#pragma once

#include <vector>

#include "stormcellar/render/image.h"

namespace stormcellar::render {

// Colour and opacity in front of whatever is behind; colours 0..1, premultiplied by alpha.
struct Layer {
    int width = 0, height = 0;
    std::vector<float> rgba;
};

// layer over background, which is opaque and has the same size at (left, top) of the image.
void composite_over(const Layer& layer, Image& background, int left, int top, int threads = 1);

}  // namespace stormcellar::render
