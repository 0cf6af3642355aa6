// render/colour/built_in_tables.h -- the colour tables that come with the program.
//
//   nws-reflectivity    dBZ     15 classes of 5 dB from 5 dBZ, the last open above
//   nws-velocity        m/s     by speed either way: green towards the radar, red away from it,
//                               bounds 5, 10, 13.5, 18.5, 25.5, 33 m/s for 10, 20, 26, 36, 50, 64
//                               knots; greys below 5 m/s, from -64 m/s, open above
//   nws-spectrum-width  m/s     bounds 2, 4, 6, 8, 10 m/s for 4, 8, 12, 16, 20 knots
//   nws-zdr, nws-rho    dB, 1   the 16 levels of the dual-polarisation products
//   nws-echo-top        km      classes of 1.5 km for 5,000 feet
//   nws-vil             kg/m2   classes of 5 kg/m2
//   phi, cfp            degree, dB   no product of the Weather Service shows them: our own colours
//   height              km      our own, safe
//   safe-reflectivity, safe-velocity, safe-zdr, safe-rho   our own, for every kind of sight
// Range folded is 77007d in all. Source: the levels of the WSR-88D's products (interface control
// document 2620003, colour tables).
//
// Safe: neighbouring classes differ by at least least_safe_step (CIEDE2000) for normal sight and
// for protanopia, deuteranopia and tritanopia as simulated by Machado, Oliveira, Fernandes (2009),
// and lightness rises from class to class (safe-velocity: with the speed, either way, whose sides
// differ by at least least_safe_sides). tests/render/safe_tables_test.cpp enforces both.
//
// Extinction is the moment's: default_extinction().
// Thread contract: tables are made once and never change.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/render/colour_table.h"

namespace stormcellar::render {

inline constexpr double least_safe_step = 6;
inline constexpr double least_safe_sides = 15;

// In the order above.
[[nodiscard]] const std::vector<ColourTable>& built_in_tables();
// not_found, naming all.
[[nodiscard]] Result<ColourTable> find_colour_table(std::string_view name);
[[nodiscard]] const ColourTable& default_colour_table(level2::Moment moment);
[[nodiscard]] const ColourTable& echo_top_colours();
[[nodiscard]] const ColourTable& vil_colours();
[[nodiscard]] const ColourTable& height_colours();

// What a picture says of a moment, and its default colours: render's layer over
// stormcellar/level2/moment.h.
struct MomentLook {
    level2::Moment moment = level2::Moment::ref;
    std::string_view title = {};     // "Correlation coefficient"
    std::size_t table = 0;           // in built_in_tables()
    bool is_never_negative = false;  // values below a table that begins at 0 do not exist
    // default_extinction()
    std::vector<ExtinctionPoint> (*extinction)(float lowest) = nullptr;
};
[[nodiscard]] const MomentLook& look_of(level2::Moment moment);

// The unit of a moment's values as tables name it: "dBZ", "m/s", "dB", "degree"; empty for RHO.
[[nodiscard]] std::string unit_of(level2::Moment moment);

// How opaque a moment's values are in a volume, per km of the drawn scene.
//   REF   the sum of a haze, which keeps weak echo in sight, and of a steep part, which makes cores
//         solid: 0.012 * 10^((v - 5 dBZ) / 40 dB) + 0.12 * 10^((v - 50 dBZ) / 10 dB), at every
//         decibel from `lowest` to 80 dBZ
//   VEL   by speed: what hardly moves is a haze, so that jets and couplets stand out
//   SW, CFP   rise with the value        ZDR  hail and debris faint, large drops dense
//   PHI   one faint haze: a phase is nowhere "more"   RHO  faint; what is not rain is denser
[[nodiscard]] std::vector<ExtinctionPoint> default_extinction(level2::Moment moment, float lowest);

}  // namespace stormcellar::render
