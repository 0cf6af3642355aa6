// render/map/legend_layout.h -- places the color bar and the legend of a picture.
//
// In a stepped table, all classes have the same length, and their lower bounds are labeled. A table
// with blends has an axis that is linear in the value, and round values are labeled.
//
// Threads   One thread at a time.
#pragma once

#include "render/map/label_builder.h"
#include "render/map/legend.h"

namespace stormcellar::render {

// Lays out an upright bar at the right of a picture, with the rows of the legend below it.
void lay_out_panel(LabelBuilder& builder, const Legend& legend, const Rect& panel);
// Lays out a horizontal bar below a picture, and then the legend in one line, or in two if there is
// no bar and more than eight rows. If `rows` is false, there is only the bar.
void lay_out_band(LabelBuilder& builder, const Legend& legend, const Rect& band, bool rows = true);

}  // namespace stormcellar::render
