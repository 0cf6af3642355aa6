// render/color/color_difference.h -- computes how different two colors look (CIEDE2000).
//
// Alpha is ignored.
//
// Units     Lab of CIE 1976 for the white D65. A difference of 1 can just be seen if the colors are
//           side by side; black and white differ by 100.
// Source    Sharma, Wu, Dalal (2005), The CIEDE2000 color-difference formula, Color Research and
//           Application 30, 21-30; sRGB by IEC 61966-2-1. Its white is taken as the sum of its
//           primaries, so that grays have a = b = 0. The weights kL, kC and kH are 1. The formula
//           jumps where two hues are opposite. Hues within 1e-9 degrees of opposite count as
//           opposite, so that the order of the two colors never matters.
// Accuracy  5e-5, half the last digit of the 34 published pairs.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

struct Lab {
    double lightness = 0;  // 0..100
    double a = 0;          // green to red
    double b = 0;          // blue to yellow
};

[[nodiscard]] Lab lab_of(const Rgba8& color);
// Converts linear sRGB (0..1) to Lab.
[[nodiscard]] Lab lab_of_linear(double red, double green, double blue);
// Converts a stored channel (0..255) to a number in proportion to light (0..1).
[[nodiscard]] double linear_of(std::uint8_t channel);

[[nodiscard]] double ciede2000(const Lab& one, const Lab& other);
[[nodiscard]] double color_difference(const Rgba8& one, const Rgba8& other);

// Figures about the difference of two pictures, over all pixels.
struct ImageDifference {
    double mean = 0;
    double percentile_99 = 0;  // the smallest difference that 99 % of the pixels do not exceed
    double max = 0;
    std::size_t pixels = 0;   // pixels compared
    std::size_t unequal = 0;  // pixels whose bytes of R, G and B differ
};
// Compares two pictures. Errors: bad_argument if the sizes differ or there are no pixels.
[[nodiscard]] Result<ImageDifference> image_difference(const Image& one, const Image& other);

}  // namespace stormcellar::render
