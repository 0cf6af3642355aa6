// render/yuv420.h -- a picture as video wants it: luma, and chroma at half the resolution.
//
// BT.709 matrix, limited range (luma 16 to 235, chroma 16 to 240), as ITU-R BT.709-6 and BT.601
// give them. Chroma stands where H.264 and VP9 put it by default: on the even columns and between
// the rows; it is filtered by 1-2-1 across and averaged down. Alpha is ignored.
// Accuracy: each sample within 0.51 of the formula.
#pragma once

#include <cstdint>
#include <vector>

#include "render/image.h"

namespace stormcellar::render {

// Sizes are even: an odd picture has its last column or row twice.
struct Yuv420 {
    int width = 0, height = 0;
    std::vector<std::uint8_t> y;     // width * height
    std::vector<std::uint8_t> u, v;  // (width / 2) * (height / 2): Cb and Cr
};

[[nodiscard]] Yuv420 to_yuv420(const Image& image);  // at least one pixel

}  // namespace stormcellar::render
