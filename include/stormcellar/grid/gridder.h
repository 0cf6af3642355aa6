// stormcellar/grid/gridder.h -- a decoded volume -> a Grid, by columns.
//
// All cells of a column share azimuth and arc, so each sweep is sampled once a column (nearest
// gate and radial), then values run up the column, linear in height between the beams of sweeps
// that are adjacent in the VCP. Nothing is invented: beyond half a beam width above the highest and
// below the lowest sweep, beyond the last gate, in azimuth gaps and where a cut is missing, cells
// are "not seen". The rule for mixed states is DESIGN section 5, in docs/geometry.md.
// Values are averaged as the method says (stormcellar/grid/method.h), those that wrap (VEL, PHI) on
// their circle. Model: WGS84 for the site frame; for the beam what the method says, by default a
// sphere of 4/3 Gaussian radius. Threads: the result has the same bits for any number of threads.
// Accuracy: the gate of a cell is that of the model within 0.15 m of range, its weights within
// 0.25 m of a beam's height and 1 m of its edges' (grid/sweep/polar_sweep.h; as a whole:
// tests/grid/gridder_oracle_test.cpp). The model's own error is in docs/geometry.md.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/frame_ladder.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/refractivity.h"
#include "stormcellar/grid/sweep_choice.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

struct GridderOptions {
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0;  // half-power; 0: that of the site's radar, beam_width_of()
    int threads = 1;
    Method method;
    // For traced beams; none: the exponential reference atmosphere.
    std::optional<RefractivityProfile> profile = std::nullopt;
    // Which of several equally fit sweeps of an elevation is taken; nearest_in_time: to the frame
    // time. See stormcellar/grid/sweep_choice.h.
    enum class Repeats { newest, nearest_in_time };
    Repeats repeats = Repeats::newest;
    // The instant that the grid is meant for; none: the start of the volume.
    std::optional<UtcTime> frame_time = std::nullopt;
    // Beside the values; what is not asked for is neither computed nor allocated.
    DetailSet details = {};
};

// Half-power beam width: 0.55 degrees for a TDWR of the station table, else 0.95 (WSR-88D).
[[nodiscard]] double beam_width_of(std::string_view icao);

// The sweeps of the moment that make_grid() grids, by its beam width and `repeats`.
[[nodiscard]] std::vector<ChosenSweep> sweeps_to_grid(const level2::Volume& volume,
                                                      const SitePosition& site,
                                                      const GridderOptions& options);

// Errors: not_found when the volume has no sweep with the moment; bad_argument for a geometry made
// for another site, a beam width that is not within 0 to 5 degrees, a frame time that no radar can
// mean, or no threads. The caller fills in provenance.source_files and .partial.
[[nodiscard]] Result<Grid> make_grid(const level2::Volume& volume, const SitePosition& site,
                                     const ColumnGeometry& geometry, const GridderOptions& options);

}  // namespace stormcellar::grid
