// render/map/legend_layout.h -- places the color bar and the legend of a picture.
//
// A stepped table has classes of equal length, labeled at their lower bounds; a table with blends
// has an axis that is linear in the value, labeled at round values.
//
// Threads   One thread at a time.
#pragma once

#include "render/map/label_builder.h"
#include "render/map/legend.h"

namespace stormcellar::render {

// Upright, at the right of a picture: the bar, then the rows of the legend.
void lay_out_panel(LabelBuilder& builder, const Legend& legend, const Rect& panel);
// Lying, below a picture: the bar, then the legend in one line. Without `rows` the bar stands
// alone.
void lay_out_band(LabelBuilder& builder, const Legend& legend, const Rect& band, bool rows = true);

}  // namespace stormcellar::render
