// render/color/moment_look.h -- the look of each moment in pictures: its title, its default tables,
// its opacity, and the built-in tables without classes.
//
//   smooth-reflectivity, smooth-velocity, smooth-spectrum-width, smooth-zdr, smooth-rho,
//   smooth-phi, smooth-cfp
//   smooth-shear        orange for counterclockwise rotation or divergence, blue for the opposite,
//                       lighter with strength
//   smooth-kdp, smooth-rain
//   smooth-quality      violet where the echo is no weather, green where it is
//   smooth-clear-air    reflectivity from -30 dBZ, for insects, birds and dust
// Colors change evenly from anchor to anchor in OKLab. The hues of smooth-reflectivity are familiar
// to forecasters. Each hue changes to the next within 1 dB of 20, 35, 50 and 65 dBZ, so that these
// bounds can be read off; within a hue only lightness and strength change. On maps, weak echo is
// translucent. Velocity is teal toward the radar and red away from it, and lighter with speed. The
// other tables become lighter with the value, except the circle of phases.
//
// For every kind of color vision the colors of two values differ by least_smooth_step or more
// (CIEDE2000) if the values are this far apart: 15 dBZ, 10 m/s of velocity up to 40 m/s, 0.005/s of
// shear up to 0.02/s, 4 m/s of spectrum width, 2 dB of ZDR, 0.1 of RHO above 0.7, 60 degrees of
// PHI, 15 dB of CFP, 0.3 of POW, 2 degrees/km of KDP, 40 mm/h of rain up to 100
// (tests/render/safe_tables_test.cpp). The stepped safe tables have this difference between
// neighboring classes, which are narrower.
//
// Threads   Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/level2/moment.h"
#include "stormcellar/render/color_table.h"

namespace stormcellar::render {

inline constexpr double least_smooth_step = 6;

// The texts and the default colors that a picture has for a moment. These extend
// stormcellar/level2/moment.h.
struct MomentLook {
    level2::Moment moment = level2::Moment::ref;
    std::string_view title = {};  // "Correlation coefficient"
    // Names of the default tables with and without classes, in built_in_tables().
    std::string_view classes = {};
    std::string_view smooth = {};
    std::vector<ExtinctionPoint> (*extinction)(float lowest) = nullptr;  // default_extinction()
    bool is_never_negative = false;  // true: values are 0 or more, so a table from 0 has them all
    // A cell of a coarse map that combines several values shows the largest if true, else the mean.
    // Moments that wrap have a rule of their own (web/data/pictures/flat_map.cpp).
    bool shows_largest = false;
};
[[nodiscard]] const MomentLook& look_of(level2::Moment moment);

// Returns the unit of a moment's values, as tables name it: "dBZ", "m/s", "dB", "degree". Returns
// an empty text for RHO.
[[nodiscard]] std::string unit_of(level2::Moment moment);

// Returns how opaque a moment's values are in a volume, per km of the drawn scene.
//   REF      A thin veil up to 40 dBZ, through which solid cores of 50 dBZ and more show:
//            0.0015 up to 5 dBZ, 0.012 at 20, 0.055 at 35, 0.25 at 45, 1.1 at 50, 4 at 60, 6 at 75,
//            given at every decibel from `lowest` to 80 dBZ.
//   VEL      By speed: slow echo is a haze, so that jets and couplets stand out.
//   AZSH     As VEL, by strength on both sides.
//   SW, CFP, KDP, RATE  Rises with the value.
//   ZDR      Hail and debris are faint, large drops dense.
//   POW      A haze that is denser where weather is more probable.
//   PHI      One faint haze, because no phase is "more" than another.
//   RHO      Faint; echo that is not rain is denser.
[[nodiscard]] std::vector<ExtinctionPoint> default_extinction(level2::Moment moment, float lowest);

// Makes the tables without classes.
[[nodiscard]] std::vector<ColorTable> make_smooth_tables();

}  // namespace stormcellar::render
