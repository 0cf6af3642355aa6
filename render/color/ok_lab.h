// render/color/ok_lab.h -- OKLab, the color space in which colors are mixed and lighted.
//
// Equal steps in OKLab look about equally large. If only the lightness changes, the hue stays.
//
// Units     Linear sRGB, 0..1; lightness 0..1, from black to white.
// Source    Ottosson (2020), A perceptual color space for image processing.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cmath>

namespace stormcellar::render {

using LinearRgb = std::array<float, 3>;

struct OkLab {
    float l = 0, a = 0, b = 0;
};

[[nodiscard]] inline OkLab ok_lab_of(const LinearRgb& c) {
    const float l = std::cbrt(0.4122214708F * c[0] + 0.5363325363F * c[1] + 0.0514459929F * c[2]);
    const float m = std::cbrt(0.2119034982F * c[0] + 0.6806995451F * c[1] + 0.1073969566F * c[2]);
    const float s = std::cbrt(0.0883024619F * c[0] + 0.2817188376F * c[1] + 0.6299787005F * c[2]);
    return {0.2104542553F * l + 0.7936177850F * m - 0.0040720468F * s,
            1.9779984951F * l - 2.4285922050F * m + 0.4505937099F * s,
            0.0259040371F * l + 0.7827717662F * m - 0.8086757660F * s};
}

// Converts OKLab to linear sRGB. If sRGB does not contain the color, some numbers are outside 0..1.
[[nodiscard]] inline LinearRgb linear_of(const OkLab& color) {
    const float l = color.l + 0.3963377774F * color.a + 0.2158037573F * color.b;
    const float m = color.l - 0.1055613458F * color.a - 0.0638541728F * color.b;
    const float s = color.l - 0.0894841775F * color.a - 1.2914855480F * color.b;
    const float l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
    return {4.0767416621F * l3 - 3.3077115913F * m3 + 0.2309699292F * s3,
            -1.2684380046F * l3 + 2.6097574011F * m3 - 0.3413193965F * s3,
            -0.0041960863F * l3 - 0.7034186147F * m3 + 1.7076147010F * s3};
}

}  // namespace stormcellar::render
