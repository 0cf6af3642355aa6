// render/wind/hodograph.h -- draws a wind profile as a hodograph.
//
// The line joins the tips of the winds from the lowest layer to the highest. Its color tells the
// height, and rings tell the speed. The vector from the middle of the rings to a point shows which
// way the air moves: right is east, up is north. Heights are above the antenna.
//
// Threads   Pure functions.
#pragma once

#include "render/wind/wind_page.h"
#include "stormcellar/base/result.h"
#include "stormcellar/retrieve/storm_motion.h"

namespace stormcellar::render {

// The place of the winds on the page.
struct HodographPlan {
    Rect plot;
    Point calm;  // the middle of the rings
    double px_per_mps = 1;
    double ring_step_mps = 10;

    [[nodiscard]] Point at(const retrieve::Motion& wind) const {
        return {calm.x + wind.u_mps * px_per_mps, calm.y - wind.v_mps * px_per_mps};
    }
};
// Plans the page so that all winds, all motions and calm fit.
[[nodiscard]] HodographPlan plan_hodograph(const WindPage& page, const WindColumn& column,
                                           const Result<retrieve::StormMotions>& motions);

// Returns the color of the line at a height above the antenna.
[[nodiscard]] Rgba8 hodograph_color(double height_m, const Units& units, Theme theme);

// Draws the page. If there are no storm motions, the page says why.
[[nodiscard]] Image draw_hodograph(const WindPage& page, const WindColumn& column,
                                   const Result<retrieve::StormMotions>& motions,
                                   const Fonts& fonts);

}  // namespace stormcellar::render
