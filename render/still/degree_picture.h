// render/still/degree_picture.h -- draws a map over latitude and longitude, whatever the projection
// of its grid.
//
// Pixels are regular in degrees and show the cell that holds their center. A cell at the center of
// the grid is two pixels wide, unless a side would then have more than 4096 pixels.
//
// Accuracy  Places on the grid are computed every eight pixels and interpolated between; the error
//           is below 0.02 cells.
// Threads   Pure; the same bits for any number of threads.
// Errors    unsupported for a grid that holds a pole, which no map of degrees can show.
#pragma once

#include "render/products/flat_field.h"
#include "render/still/plane_picture.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

struct DegreePicture {
    // The edges of the outer pixels. West is at least -180 and below 180; across the antimeridian,
    // east is above 180.
    EarthBox box;
    Image image;  // clear outside of the grid
};

[[nodiscard]] Result<DegreePicture> draw_in_degrees(const grid::GridSpec& spec,
                                                    const FlatField& field, const ColorTable& table,
                                                    int threads);

inline constexpr int most_degree_pixels = 4096;  // along a side; globe programs take no more

}  // namespace stormcellar::render
