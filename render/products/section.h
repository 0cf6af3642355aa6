// render/products/section.h -- a vertical cross section between two places.
//
// The section follows the geodesic from one place to the other, and is sampled at the centers of
// the pixels of a picture. Samples are bilinear between the centers of columns and linear in
// height; cell_mixer.h has the rule for states. The outermost cells reach half a cell beyond their
// centers; farther out there is no grid. Heights run from sea level (or from the lowest cells, if
// they are lower) to the highest cells. Air under the lowest cells counts as not seen.
//
// Accuracy  Places are within 1e-6 m of the geodesic (stormcellar/grid/site_frame.h).
// Threads   Pure functions; the same bits for any number of threads.
#pragma once

#include <vector>

#include "render/image/canvas.h"
#include "render/products/flat_field.h"
#include "render/products/ground.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct Section {
    SectionLine line;
    double length_m = 0;
    double bottom_m = 0, top_m = 0;
    FlatField field;  // columns along the line, rows from bottom to top
    // 1 for each column of the field where the grid has cells, else 0
    std::vector<std::uint8_t> in_grid;
};

// Cuts a section. `width` and `height` are at least 1; the line must be valid (validate(Scene)).
[[nodiscard]] Section cut_section(const grid::BrickView& view, level2::Moment moment,
                                  const SectionLine& line, int width, int height, int threads);

// Returns bad_argument if no part of the section is in the grid; the message says where the grid
// is.
[[nodiscard]] Status check_in_grid(const Section& section, const grid::GridSpec& spec);

// The place of the section in a picture of this size. There is room for axes unless `labels` is
// false.
struct SectionPlace {
    int left = 0, top = 0, width = 1, height = 1;

    [[nodiscard]] bool has(int x, int y) const {
        return x >= left && x < left + width && y >= top && y < top + height;
    }
};
[[nodiscard]] SectionPlace section_place(int width, int height, double scale, bool labels);

// Draws the section with axes: distance and height in their units, latitude and longitude of both
// ends, and the factor by which heights are stretched to fill the picture. If `fonts` is null,
// there are no axes.
[[nodiscard]] Image draw_section(const Section& section, const ColorTable& table,
                                 const SectionPlace& place, int width, int height,
                                 const GroundLook& look, const Units& units, const Fonts* fonts,
                                 int threads = 1);

// Returns "35.333 N 97.278 W", rounded to 0.001 degrees.
[[nodiscard]] std::string place_text(grid::GeoPoint point);

}  // namespace stormcellar::render
