// stormcellar/retrieve/vertical_liquid.h -- vertically integrated liquid (VIL) of a column of
// reflectivity.
//
// Method    3.44e-6 Z^(4/7) kg/m3, with Z in mm6/m3, is integrated over height. Z is capped at 56
//           dBZ, so that hail does not count as liquid water. A layer between two cells has the
//           mean Z of both; no echo is Z = 0. Beside a cell that was not seen or is range folded,
//           half of the layer counts. The first and the last cell reach to the edges of the column.
// Below the lowest beam  It rains below the lowest beam, too. So the lowest cell that was seen is
//           extended down to the height of the radar, or to the bottom of the column if that is
//           higher. A lowest cell without echo adds nothing. Above the highest beam nothing counts.
// Units     kg/m2. Heights are above mean sea level, in meters.
// Source    Greene and Clark (1972), Mon. Wea. Rev. 100, 548.
// Errors    A column in which nothing was seen has 0.
// Accuracy  vertical_liquid_test.cpp enforces each line for layers of 500 m.
//             even column             1e-6 of the closed form
//             ramp of 3 dB/km         0.5 %
//             parabola in dB, 55 dBZ  0.5 %
//           Between beams the column is not known. bench/compare_vil.py prints errors at 40 to 120
//           km from a simulated radar (VCP 212): at most 4 % of a ramp and of a storm, 5 % of a
//           plateau on the ground, 22 % of a plateau from 3 to 9 km, whose edges are between beams.
//           At 20 km, where the top is above the highest beam, up to 24 % are missing.
// Not covered  Hail below 56 dBZ, melting snow, attenuation. Far from the radar most of the column
//           is below the lowest beam, where its liquid is an assumption.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>

#include "stormcellar/grid/grid.h"

namespace stormcellar::retrieve {

// The heights of the cells of a column.
struct LiquidColumn {
    std::span<const double> levels_m;  // of the middles of the cells; they grow
    double bottom_m = 0, top_m = 0;    // the edges of the first and the last cell
    // The height of the radar. None: unknown; then half a layer counts below the lowest cell.
    std::optional<double> radar_m = {};
};

// Returns the VIL of a column. `dbz` and `status` have an element for each level; dbz matters only
// where the status is value.
[[nodiscard]] double vertical_liquid_kg_per_m2(const LiquidColumn& column,
                                               std::span<const float> dbz,
                                               std::span<const grid::CellStatus> status);

// Returns the mean height of the radars of a grid, for LiquidColumn::radar_m; none without a radar.
[[nodiscard]] std::optional<double> mean_radar_height_m(std::span<const grid::SitePosition> sites);

}  // namespace stormcellar::retrieve
