// tests/images/picture_difference.h -- measures how much two pictures differ to the eye.
//
// Letters and thin lines differ slightly between versions of FreeType and Cairo; everything else
// has the same bits. So both pictures are first averaged over 3 x 3 pixels. Then colors are
// compared (CIEDE2000), over the whole picture and in tiles of 8 x 8 pixels. Tiles show a single
// label that moved, even in a large picture.
#pragma once

#include "stormcellar/base/result.h"
#include "stormcellar/render/image.h"

namespace stormcellar::images {

struct PictureDifference {
    double percentile_99 = 0;    // of all pixels
    double visible_share = 0;    // the share of the pixels that differ by more than `visible`
    double worst_tile = 0;       // the largest mean of a tile
    int tile_x = 0, tile_y = 0;  // top left pixel of that tile
};

inline constexpr double visible = 3;

// The largest allowed differences. The limit for a tile decides about labels. In
// tests/images/synthetic_picture_test.cpp, a label that moved makes a tile differ by at least 3.8,
// which must be found. Letters of another library make a tile differ by at most 2.1, which is
// tolerated.
struct Tolerance {
    double percentile_99 = 3;
    double visible_share = 0.01;
    double worst_tile = 3;
};

// Compares two pictures. Errors: bad_argument if their sizes differ.
[[nodiscard]] Result<PictureDifference> difference_of(const render::Image& one,
                                                      const render::Image& other);
[[nodiscard]] bool within(const PictureDifference& difference, const Tolerance& tolerance = {});

// Returns `one` in gray, with visible differences in red, deeper where they are larger. Both
// pictures must have the same size.
[[nodiscard]] render::Image picture_of_difference(const render::Image& one,
                                                  const render::Image& other);

}  // namespace stormcellar::images
