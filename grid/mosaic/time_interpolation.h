// grid/mosaic/time_interpolation.h -- a grid for an instant between two volumes of one site.
//
// A site's volumes come when they come, a loop wants frames at regular times. The rungs, from cheap
// to exact:
//   nearest    the volume whose middle is nearer to the instant, as it is
//   blend      the two volumes, by weights linear in time
//   advected   the same, each moved with the echo to the instant: semi-Lagrangian, from both ends,
//              bilinear between columns
// With `sweep_times` a cell's own time counts (grid/sweep/sweep_clock.h) instead of its volume's
// middle: for weights, and for how far it is moved. So all heights of a frame are of one instant.
// States  between columns by the status rule (grid/sweep/mixture.h) with bilinear weights; between
// the two
//         ends the same with the weights in time, but for a cell that one end has not seen: the
//         other one's stands. Values in dB. What wraps (VEL, PHI), and states of theirs, is not
//         mixed: the column and the end that weigh most stand.
//         No echo enters a value at the stated range curve of grid/beam/detection_limit.h.
// Errors  not found by any bound: they are in what the echo did meanwhile. docs/accuracy.md has
// them
//         as measured, on volumes held out.
// Threads the same bits for any number of threads.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "grid/mosaic/motion.h"
#include "grid/sweep/sweep_clock.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"

namespace stormcellar::grid {

enum class TimeMethod { nearest, blend, advected };
struct TimeMethodFacts {
    TimeMethod method = TimeMethod::nearest;
    std::string_view name = {};
};
inline constexpr auto time_method_facts = std::to_array<TimeMethodFacts>({
    {TimeMethod::nearest, "nearest"},
    {TimeMethod::blend, "blend"},
    {TimeMethod::advected, "advected"},
});
[[nodiscard]] std::string_view time_method_name(TimeMethod method);
[[nodiscard]] std::optional<TimeMethod> time_method_from_name(std::string_view name);

// A grid of one volume and its times.
struct TimedView {
    BrickView view;
    UtcTime middle;                          // of the volume
    std::span<const SweepTime> sweeps = {};  // empty: not known, all is of the middle
};

struct InstantOptions {
    UtcTime instant;
    level2::Moment moment = level2::Moment::ref;
    TimeMethod method = TimeMethod::advected;
    bool sweep_times = true;
    const MotionField* motion = nullptr;  // none: nothing moves
    int threads = 1;
};

// Both of the geometry's spec; `after` none: the volume before alone, moved to the instant where
// the method says so. Beyond the two middles nothing is extrapolated but positions: the nearer
// end has all the weight.
// bad_argument: views of other specs than the geometry's or of different quantisation.
[[nodiscard]] Result<BrickGrid> grid_at(const TimedView& before,
                                        const std::optional<TimedView>& after,
                                        const ColumnGeometry& geometry,
                                        const InstantOptions& options);

}  // namespace stormcellar::grid
