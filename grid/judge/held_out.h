// grid/judge/held_out.h -- scores how well a grid that was made for an instant matches a volume
// that the radar measured at that instant.
//
// The middle volume of three volumes in a row is held out. Each method of interpolation in time
// (grid/mosaic/time_interpolation.h) reconstructs it from the other two volumes. So the errors
// include the growth and decay of the echo and the noise of the gates, in the same way for each
// method.
//
// Units     Errors of REF in dB, over cells that both grids have seen (value or no echo) and that
//           have 5 dBZ or more in at least one of the grids. No echo, and anything below 0 dBZ,
//           counts as 0 dBZ.
// Threads   Pure functions.
#pragma once

#include <string>
#include <vector>

#include "grid/mosaic/time_interpolation.h"
#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/base/result.h"

namespace stormcellar::grid {

struct HeldOutScore {
    TimeMethod method = TimeMethod::nearest;
    accuracy::ErrorSummary error;
    double mean_db = 0;  // reconstructed minus measured
    // Share of the cells measured at 20 dBZ or more that were reconstructed below 10 dBZ.
    double echo_missed = 0;
    // Share of the cells reconstructed at 20 dBZ or more that were measured below 10 dBZ.
    double echo_invented = 0;
    double seconds = 0;  // time of the reconstruction, including the motion
};

struct HeldOut {
    std::vector<HeldOutScore> scores;  // nearest, blend, advected
    // The motion of all echo together, or none if it is unknown.
    std::optional<CellMotion> motion_mps;
};

// Scores the methods. Errors: not_found if there are no cells to compare; those of grid_at().
[[nodiscard]] Result<HeldOut> score_held_out(const TimedView& before, const TimedView& held_out,
                                             const TimedView& after, const ColumnGeometry& geometry,
                                             int threads);

}  // namespace stormcellar::grid
