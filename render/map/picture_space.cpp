#include "render/map/picture_space.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::render {
namespace {

// A picture is wide if its ratio of width to height is above the first number, and tall if it is
// below the second.
constexpr double least_wide = 1.2;
constexpr double most_tall = 0.72;
constexpr double most_scale = 16;

// Lengths at scale 1, and the size of a picture whose scale is 1.
struct Measures {
    double width, height;
    double header, footer, panel, band;
};

Measures measures_of(PictureShape shape) {
    switch (shape) {
        case PictureShape::wide:
            return {796, 532, 46, 36, 118, 0};
        case PictureShape::square:
            return {600, 640, 46, 36, 0, 62};
        case PictureShape::tall:
            break;
    }
    return {540, 900, 68, 38, 0, 66};
}

}  // namespace

PictureSpace space_of(int width, int height) {
    PictureSpace space;
    const double aspect = static_cast<double>(width) / height;
    if (aspect < least_wide) {
        space.shape = aspect < most_tall ? PictureShape::tall : PictureShape::square;
    }
    const Measures at = measures_of(space.shape);
    space.scale =
        std::clamp(std::min(width / at.width, height / at.height), least_text_scale, most_scale);
    const auto scaled = [&](double length) {
        return static_cast<int>(std::lround(length * space.scale));
    };
    space.header = scaled(at.header);
    space.footer = scaled(at.footer);
    space.panel = scaled(at.panel);
    space.band = scaled(at.band);
    return space;
}

}  // namespace stormcellar::render
