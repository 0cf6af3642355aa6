// tests/images/picture_difference.h -- whether two pictures look the same.
//
// Letters and thin lines differ slightly with another FreeType or Cairo; everything else is the
// same to the bit. So both pictures are first averaged over 3 x 3 pixels. Then colors are compared
// (CIEDE2000), over the whole picture and in tiles of 8 x 8 pixels, so that one label that moved
// shows even in a large picture.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::images {

struct PictureDifference {
    double percentile_99 = 0;    // of all pixels
    double visible_share = 0;    // the share of the pixels that differ by more than `visible`
    double worst_tile = 0;       // the largest mean of a tile
    int tile_x = 0, tile_y = 0;  // its top left pixel
};

inline constexpr double visible = 3;

// The difference that other letters may make. The tile decides about labels: the smallest
// difference that tests/images/synthetic_picture_test.cpp must find is a tile of 3.8 (a label that
// moved), and the largest that it tolerates is 2.1.
struct Tolerance {
    double percentile_99 = 3;
    double visible_share = 0.01;
    double worst_tile = 3;
};

// Errors: bad_argument if the sizes differ.
[[nodiscard]] Result<PictureDifference> difference_of(const render::Image& one,
                                                      const render::Image& other);
[[nodiscard]] bool within(const PictureDifference& difference, const Tolerance& tolerance = {});

// For two pictures of one size: returns the first in gray, with visible differences in red, deeper
// if larger.
[[nodiscard]] render::Image picture_of_difference(const render::Image& one,
                                                  const render::Image& other);

}  // namespace stormcellar::images
