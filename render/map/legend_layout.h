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

// Lays out an upright bar at the right of a picture, with the rows of the legend below it.
void lay_out_panel(LabelBuilder& builder, const Legend& legend, const Rect& panel);
// Lays out a horizontal bar below a picture, then the legend in one line. Without `rows` there is
// only the bar.
void lay_out_band(LabelBuilder& builder, const Legend& legend, const Rect& band, bool rows = true);

}  // namespace stormcellar::render
