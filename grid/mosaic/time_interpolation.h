// grid/mosaic/time_interpolation.h -- makes a grid for an instant between two volumes of one site.
//
// The volumes of a site come at irregular times, but a loop needs frames at regular times. There
// are three methods, from cheap to exact:
//   nearest   The volume whose middle is nearer to the instant, unchanged.
//   blend     Both volumes, with weights linear in time.
//   advected  Both volumes, each moved with its echo to the instant (semi-Lagrangian, bilinear
//             between columns), with weights linear in time.
// With `sweep_times`, each cell has a time of its own (grid/sweep/sweep_clock.h). Otherwise, it has
// the time of its volume's middle. The time determines the weight of the cell and how far it moves.
// So all heights of a frame show the same instant.
//
// States    Between columns, the status rule (grid/sweep/mixture.h) applies with bilinear weights.
//           Between the two volumes, it applies with the weights in time; but if one volume has not
//           seen a cell, the cell is as in the other volume. Values are mixed in dB. Moments that
//           wrap (VEL, PHI) and classes (HCA) are not mixed, nor are their states: the column and
//           the volume with the largest weight determine the cell. No echo enters a value with the
//           range curve of grid/beam/detection_limit.h.
// Accuracy  No bound is known, because the errors come from changes of the echo between the
//           volumes. docs/accuracy.md has the errors measured on held-out volumes.
// Threads   Pure. The result has the same bits for any number of threads.
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

// The grid of a volume, and the times of the volume.
struct TimedView {
    BrickView view;
    UtcTime middle;  // the middle time of the volume
    // The times of the sweeps. If empty, they are unknown, and `middle` counts for the whole
    // volume.
    std::span<const SweepTime> sweeps = {};
};

struct InstantOptions {
    UtcTime instant;
    level2::Moment moment = level2::Moment::ref;
    TimeMethod method = TimeMethod::advected;
    bool sweep_times = true;
    const MotionField* motion = nullptr;  // null: nothing moves
    int threads = 1;
};

// Makes a grid for an instant. Both views must have the spec of the geometry. If `after` is none,
// only `before` is used; the method `advected` moves it to the instant. If the instant is not
// between the two middles, only the nearer volume counts, and its echo is extrapolated. Errors:
// bad_argument for views with another spec than the geometry's, or with different quantizations.
[[nodiscard]] Result<BrickGrid> grid_at(const TimedView& before,
                                        const std::optional<TimedView>& after,
                                        const ColumnGeometry& geometry,
                                        const InstantOptions& options);

}  // namespace stormcellar::grid
