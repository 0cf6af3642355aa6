// retrieve/cells/track_motion.h -- the motion of a track and its forecasts, each with its error.
//
// Model     A cell moves in a straight line in the azimuthal equidistant plane about its newest
//           position. Errors of positions are independent and of equal size. Their variance is the
//           mean of the variance about the line, weighted by its degrees of freedom, and an assumed
//           variance of weight 4.
// Prior     The motion of the echo pattern, or of the cell from which a track split. The line and
//           the prior are weighted by the inverse squares of their errors.
// Forecast  The newest position, moved. Its error has three parts: the error of the position, the
//           error of the motion times the lead time, and an error for storms that change.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::retrieve {

// Standard error, per component, if the motion of the echo pattern is taken for the motion of one
// cell: cells deviate from the pattern by some m/s (Bunkers et al. 2000: 7.5 m/s for supercells).
inline constexpr double echo_motion_error_mps = 5;
// Growth of the error of forecasts because storms turn, grow and decay, m per s and axis.
inline constexpr double own_change_mps = 4;

// Combines the line through the last sightings with a prior. If there is only one sighting, returns
// the prior, or none if there is no prior.
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
