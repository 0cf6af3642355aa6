// grid/judge/held_out.h -- how well a grid for an instant is what was seen there: scored on a
// volume that was not used.
//
// Of three volumes the middle one is held out and made again from the other two, by every rung of
// time (grid/mosaic/time_interpolation.h). So errors are against what the radar saw: the echo's own
// growth and decay, and the gates' own noise, are in them, for each rung alike. Errors  of REF in
// dB, over cells that both have seen (value or no echo) and of which one shows 5 dBZ
//         or more; what is below 0 dBZ, or no echo, counts as 0 dBZ.
// Threads pure functions.
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
    double seconds = 0;        // to make it, motion included
};

struct HeldOut {
    std::vector<HeldOutScore> scores;  // nearest, blend, advected
    // Of all echo together, m/s; none where it was not known.
    std::optional<CellMotion> motion_mps;
};

// not_found when there are no cells to compare; else the errors of grid_at().
[[nodiscard]] Result<HeldOut> score_held_out(const TimedView& before, const TimedView& held_out,
                                             const TimedView& after, const ColumnGeometry& geometry,
                                             int threads);

}  // namespace stormcellar::grid
