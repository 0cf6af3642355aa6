// render/products/section.h -- a vertical cross section between two places.
//
// Along the geodesic from one to the other, at the middles of the pixels of a picture: bilinear in
// the columns' centres, linear in height, by the status rule (cell_mixer.h). Half a cell beyond the
// outermost centres the outermost cells stand, as everywhere; further out there is no grid. Heights
// run from sea level (or the lowest cells, if these lie below it) to the highest cells; air under
// the lowest cells counts as not seen.
// Accuracy: places 1e-6 m of the geodesic (stormcellar/grid/site_frame.h).
// The same bits for any number of threads.
#pragma once

#include <vector>

#include "render/image/canvas.h"
#include "render/products/flat_field.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/render/colour_table.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct Section {
    SectionLine line;
    double length_m = 0;
    double bottom_m = 0, top_m = 0;
    FlatField field;                    // columns along the line, rows upwards
    std::vector<std::uint8_t> in_grid;  // of each column of the field: 1 where the grid has cells
};

// `width` and `height` at least 1, the line valid (validate(Scene)).
[[nodiscard]] Section cut_section(const grid::BrickView& view, level2::Moment moment,
                                  const SectionLine& line, int width, int height, int threads);

// bad_argument, saying where the grid is, when no part of the section lies in it.
[[nodiscard]] Status check_in_grid(const Section& section, const grid::GridSpec& spec);

// Where in a picture of this size the section lies: room for axes, unless `labels` are off.
struct SectionPlace {
    int left = 0, top = 0, width = 1, height = 1;

    [[nodiscard]] bool has(int x, int y) const {
        return x >= left && x < left + width && y >= top && y < top + height;
    }
};
[[nodiscard]] SectionPlace section_place(int width, int height, double scale, bool labels);

// The section with axes: distance and height in km, both ends' latitude and longitude, and by how
// much heights are stretched, which is what fills the picture. `fonts` null: no axes.
[[nodiscard]] Image draw_section(const Section& section, const ColourTable& table,
                                 const SectionPlace& place, int width, int height, double scale,
                                 const Fonts* fonts);

// "35.333 N 97.278 W", rounded to 0.001 degrees.
[[nodiscard]] std::string place_text(grid::GeoPoint point);

}  // namespace stormcellar::render
