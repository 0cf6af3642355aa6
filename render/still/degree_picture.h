// render/still/degree_picture.h -- draws a map over latitude and longitude, whatever projection its
// grid has.
//
// Pixels are equally spaced in degrees and show the cell that holds their center. A cell at the
// center of the grid is two pixels wide, or less if a side would then have more than 4096 pixels.
//
// Accuracy  Places on the grid are computed every eight pixels and interpolated between these; the
//           error is below 0.02 cells.
// Threads   Pure; the same bits for any number of threads.
// Errors    unsupported for a grid that holds a pole, because no map of degrees can show it.
#pragma once

#include "render/products/flat_field.h"
#include "render/still/plane_picture.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/image.h"

namespace stormcellar::render {

struct DegreePicture {
    // The outer edges of the picture. West is at least -180 and below 180. If the picture crosses
    // the antimeridian, east is above 180.
    EarthBox box;
    Image image;  // transparent outside the grid
};

[[nodiscard]] Result<DegreePicture> draw_in_degrees(const grid::GridSpec& spec,
                                                    const FlatField& field, const ColorTable& table,
                                                    int threads);

inline constexpr int most_degree_pixels = 4096;  // along a side; globe programs do not take more

}  // namespace stormcellar::render
