// grid/judge/held_out.h -- how close a grid for an instant comes to what the radar saw then, scored
// on a volume that was held out.
//
// Of three volumes the middle one is held out, and made again from the two others by every rung of
// time (grid/mosaic/time_interpolation.h). Errors are thus against what the radar saw. They include
// the growth and decay of the echo and the noise of the gates, in the same way for each rung.
//
// Units     Errors of REF in dB, over cells that both have seen (value or no echo), one of which
//           shows 5 dBZ or more. Anything below 0 dBZ, and no echo, counts as 0 dBZ.
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
    double mean_db = 0;        // made minus seen
    double echo_missed = 0;    // share of cells seen at 20 dBZ or more that were made below 10
    double echo_invented = 0;  // share of cells made at 20 dBZ or more that were seen below 10
    double seconds = 0;        // time to make it, including the motion
};

struct HeldOut {
    std::vector<HeldOutScore> scores;  // nearest, blend, advected
    // The motion of all echo together in m/s; none if it was not known.
    std::optional<CellMotion> motion_mps;
};

// Scores the rungs. Errors: not_found if there are no cells to compare; those of grid_at().
[[nodiscard]] Result<HeldOut> score_held_out(const TimedView& before, const TimedView& held_out,
                                             const TimedView& after, const ColumnGeometry& geometry,
                                             int threads);

}  // namespace stormcellar::grid
