// render/color/smooth_tables.h -- the built-in tables without classes, one for each moment.
//
//   smooth-reflectivity, smooth-velocity, smooth-spectrum-width, smooth-zdr, smooth-rho,
//   smooth-phi, smooth-cfp
//   smooth-clear-air    reflectivity from -30 dBZ, for insects, birds and dust
// Colors change evenly from anchor to anchor in OKLab. The hues of smooth-reflectivity are familiar
// to forecasters. They change within 1 dB of 20, 35, 50 and 65 dBZ, so that these bounds can be
// read off; inside a hue only lightness and strength change. On maps weak echo is translucent.
// Velocity is teal toward the radar and red away from it, lighter with speed. The other tables,
// except the circle of phases, become lighter with the value.
//
// For every kind of color vision two values that are far enough apart differ by least_smooth_step
// or more (CIEDE2000): 15 dBZ, 10 m/s up to 40 m/s, 4 m/s of spectrum width, 2 dB of ZDR, 0.1 of
// RHO above 0.7, 60 degrees, 15 dB (tests/render/safe_tables_test.cpp). The stepped safe tables
// keep this distance between their classes, which are narrower.
//
// Threads   Pure.
#pragma once

#include <vector>

#include "stormcellar/render/color_table.h"

namespace stormcellar::render {

inline constexpr double least_smooth_step = 6;

// Makes the tables in the order of the moments, followed by the table for clear air.
[[nodiscard]] std::vector<ColorTable> make_smooth_tables();

}  // namespace stormcellar::render
