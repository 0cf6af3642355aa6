// render/image/layer.h -- a translucent picture, and its composition over another picture.
//
// The composition uses SIMD by Highway, with the same bits on every target and for any number of
// threads.
//
// Threads   Pure. composite_over() uses `threads` threads of its own.
#pragma once

#include <vector>

#include "stormcellar/render/image.h"

namespace stormcellar::render {

// The colors and the opacity in front of a background. Colors are 0..1, premultiplied by alpha.
struct Layer {
    int width = 0, height = 0;
    std::vector<float> rgba;
};

// Draws the layer over the background, which must be opaque, at (left, top) of the image.
void composite_over(const Layer& layer, Image& background, int left, int top, int threads = 1);

}  // namespace stormcellar::render
