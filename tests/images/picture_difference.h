// tests/images/picture_difference.h -- whether two pictures look the same.
//
// Letters and thin lines come out a little different with another FreeType or Cairo, everything
// else to the bit. So both pictures are first averaged over 3 x 3 pixels; then colors are compared
// (CIEDE2000), over the whole picture and in tiles of 8 x 8 pixels, where one label that moved
// cannot hide behind a large picture that did not.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::images {

struct PictureDifference {
    double percentile_99 = 0;    // of all pixels
    double visible_share = 0;    // of the pixels: more than `visible` apart
    double worst_tile = 0;       // the largest mean of a tile
    int tile_x = 0, tile_y = 0;  // its top left pixel
};

inline constexpr double visible = 3;

// What other letters may do. A tile decides about labels: of all that
// tests/images/synthetic_picture_test.cpp finds the least is a tile of 3.8 (a label that
// moved), of what it tolerates the most is 2.1.
struct Tolerance {
    double percentile_99 = 3;
    double visible_share = 0.01;
    double worst_tile = 3;
};

// bad_argument when the sizes differ.
[[nodiscard]] Result<PictureDifference> difference_of(const render::Image& one,
                                                      const render::Image& other);
[[nodiscard]] bool within(const PictureDifference& difference, const Tolerance& tolerance = {});

// Of two pictures of one size: the first in gray, what differs visibly in red, the more the deeper.
[[nodiscard]] render::Image picture_of_difference(const render::Image& one,
                                                  const render::Image& other);

}  // namespace stormcellar::images
