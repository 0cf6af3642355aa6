// retrieve/cells/track_motion.h -- the motion of a track and its forecasts, each with its error.
//
// Model     A cell moves in a straight line in the azimuthal equidistant plane about its newest
//           position. Each position errs alike and independently. The scatter about the line
//           changes the assumed error of positions: it counts as its degrees of freedom, the
//           assumed error as 4.
// Prior     The motion of the echo pattern, or of the cell from which a track split. The line and
//           the prior are weighted by the inverse squares of their errors.
// Forecast  The newest position, moved. Its error has three parts: that of the position, that of
//           the motion times the lead time, and the change of motion that storms make themselves.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::retrieve {

// Standard error of the motion of the echo pattern as the motion of one cell, per component: cells
// deviate from the pattern by some m/s (Bunkers et al. 2000: 7.5 m/s for supercells).
inline constexpr double echo_motion_error_mps = 5;
// Growth of the error of forecasts because storms turn, grow and decay, m per s and axis.
inline constexpr double own_change_mps = 4;

// Joins the line through the last sightings with a prior. Returns the prior if there is one
// sighting, and none without either.
[[nodiscard]] std::optional<TrackMotion> motion_of_track(std::span<const CellSighting> sightings,
                                                         const std::optional<TrackMotion>& prior,
                                                         double position_error_m);

// Moves a place.
[[nodiscard]] grid::GeoPoint moved_place(grid::GeoPoint place, const Motion& motion,
                                         double seconds);

[[nodiscard]] std::vector<CellForecast> forecast_track(const CellSighting& newest,
                                                       const TrackMotion& motion,
                                                       double position_error_m);

}  // namespace stormcellar::retrieve
