// render/wind/wind_barb.h -- draws a wind as a barb.
//
// The staff points to where the wind comes from. On its right, as seen from the place of the wind,
// a flag counts 50 knots, a long barb 10 and a short barb 5, after rounding to 5 knots. A wind
// below 2.5 knots is a circle.
//
// Source    WMO Manual on the Global Data-processing and Forecasting System, for the northern
//           hemisphere.
// Threads   Pure functions, except that they draw on the canvas.
#pragma once

#include "render/image/canvas.h"
#include "stormcellar/retrieve/wind_profile.h"

namespace stormcellar::render {

struct BarbParts {
    int flags = 0, long_barbs = 0, short_barbs = 0;
};
[[nodiscard]] BarbParts barb_parts(double knots);

void draw_wind_barb(Canvas& canvas, Point place, const retrieve::Motion& wind, double length,
                    double line_width, Rgba8 color);

}  // namespace stormcellar::render
