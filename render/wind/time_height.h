// render/wind/time_height.h -- draws the wind profiles of one station by time and height.
//
// Each wind is a barb whose color tells its speed; likely birds are gray. If there is no room for
// all winds, volumes and layers are left out evenly. Heights are above sea level.
//
// Threads   Pure functions.
#pragma once

#include <span>

#include "render/wind/wind_page.h"

namespace stormcellar::render {

struct TimeHeightPlan {
    Rect plot;
    UtcTime first, last;
    double bottom_m = 0, top_m = 1;    // above sea level
    std::size_t layer_step = 1;        // 2: every other layer is drawn
    std::vector<std::size_t> columns;  // the volumes that are drawn
    double barb_px = 24;

    [[nodiscard]] double x_of(UtcTime time) const;
    [[nodiscard]] double y_of(double height_m) const;  // above sea level
};
// Plans the page. The columns must be in order of time; there is at least one.
[[nodiscard]] TimeHeightPlan plan_time_height(const WindPage& page,
                                              std::span<const WindColumn> columns);

// Returns the color of a barb.
[[nodiscard]] Rgba8 wind_speed_color(double speed_mps, const Units& units, Theme theme);

[[nodiscard]] Image draw_time_height(const WindPage& page, std::span<const WindColumn> columns,
                                     const Fonts& fonts);

}  // namespace stormcellar::render
