// render/color/built_in_tables.h -- the color tables that come with the program.
//
//   nws-reflectivity    dBZ     15 classes of 5 dB from 5 dBZ, the last class open above
//   nws-velocity        m/s     by speed in both directions: green toward the radar, red away from
//                       it, bounds 5, 10, 13.5, 18.5, 25.5, 33 m/s for 10, 20, 26, 36, 50, 64
//                       knots; gray below 5 m/s; begins at -64 m/s, open above
//   nws-spectrum-width  m/s     bounds 2, 4, 6, 8, 10 m/s for 4, 8, 12, 16, 20 knots
//   nws-zdr, nws-rho    dB, 1   the 16 levels of the dual-polarization products
//   nws-echo-top        km      classes of 1.5 km for 5,000 feet
//   nws-vil             kg/m2   classes of 5 kg/m2
//   phi, cfp            degree, dB   our own colors, because no product of the Weather Service
//                       shows these moments
//   height              km      our own colors, safe
//   water-density       g/m3    our own colors for VIL density; large hail is likely from 3.5 g/m3
//                               (Amburn and Wolf 1997), where red begins
//   hail-size           mm      our own colors for MESH; green begins at the 25 mm of severe hail
//   hail-probability    %       our own colors for POSH; green begins at 50 %
//   hail-index          J/m/s   our own colors for SHI: those of the size that follows from SHI
//   rain-depth          mm      our own colors for rain totals
//   safe-reflectivity, safe-velocity, safe-zdr, safe-rho   our own colors, for every kind of color
//                                                          vision
//   smooth-...          one table without classes for each moment (render/color/moment_look.h)
// All tables draw range folded in the color usual_range_folded. The opacity of a moment's table is
// default_extinction(), but smooth-clear-air is denser. Tables of other products are never drawn as
// volumes.
//
// In a safe table, neighboring classes differ by at least least_safe_step (CIEDE2000), for normal
// vision and for protanopia, deuteranopia and tritanopia as Machado, Oliveira and Fernandes (2009)
// simulate them. Lightness rises from class to class. In safe-velocity it rises with the speed in
// both directions, and the two sides differ by at least least_safe_sides.
// tests/render/safe_tables_test.cpp enforces this.
//
// Source    The levels of the WSR-88D's products (interface control document 2620003, color
//           tables).
// Threads   Tables are made once and never change, so any thread may use them.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "render/color/moment_look.h"
#include "stormcellar/base/result.h"
#include "stormcellar/render/color_table.h"

namespace stormcellar::render {

inline constexpr double least_safe_step = 6;
inline constexpr double least_safe_sides = 15;
// The color of range folded air in all built-in tables, and in color files that name no such color.
inline constexpr Rgba8 usual_range_folded = {0x77, 0x00, 0x7D, 255};

// Returns the tables in the order above.
[[nodiscard]] const std::vector<ColorTable>& built_in_tables();
// Returns a table by its name. Errors: not_found; the message gives the nearest name, or else lists
// all tables.
[[nodiscard]] Result<ColorTable> find_color_table(std::string_view name);
// Return the default tables of a moment: the table with classes, and the table without classes.
[[nodiscard]] const ColorTable& default_color_table(level2::Moment moment);
[[nodiscard]] const ColorTable& smooth_color_table(level2::Moment moment);
// Returns the moment whose tables a moment has: VEL for VELD and SRV, AZSH for DIVG.
[[nodiscard]] level2::Moment table_moment(level2::Moment moment);
[[nodiscard]] const ColorTable& clear_air_colors();
[[nodiscard]] const ColorTable& echo_top_colors();
[[nodiscard]] const ColorTable& vil_colors();
[[nodiscard]] const ColorTable& height_colors();
[[nodiscard]] const ColorTable& vil_density_colors();
[[nodiscard]] const ColorTable& hail_size_colors();
[[nodiscard]] const ColorTable& hail_probability_colors();
[[nodiscard]] const ColorTable& hail_index_colors();
[[nodiscard]] const ColorTable& rain_total_colors();

// The families. A family has one table for each moment: "smooth" has the default table without
// classes, and "nws" the default table with classes.
inline constexpr std::array<std::string_view, 2> color_families{"smooth", "nws"};
// Returns the table of a moment in a family, or null if there is no such family.
[[nodiscard]] const ColorTable* table_of_family(std::string_view family, level2::Moment moment);

}  // namespace stormcellar::render
