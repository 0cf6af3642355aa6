// stormcellar/grid/gridder.h -- makes a Grid from a decoded volume, column by column.
//
// All cells of a column share azimuth and arc, so each sweep is sampled once for each column
// (nearest gate and radial). Then the column is filled upward, linear in height between the beams
// of sweeps that are adjacent in the VCP. The gridder invents nothing: cells are "not seen" more
// than half a beam width above the highest and below the lowest sweep, beyond the last gate, in
// azimuth gaps, and where a cut is missing. docs/geometry.md has the rule for mixed states. Other
// methods (stormcellar/grid/method.h) may take more gates.
//
// Values are averaged as the method says. Values that wrap (VEL, PHI) are averaged on their circle,
// unless the method says otherwise.
//
// Model     WGS84 for the site frame. The method selects the beam; by default it is over a sphere
//           of 4/3 Gaussian radius.
// Units     Values are in the unit of the moment; angles are in degrees.
// Threads   Pure functions; make_grid() uses `threads` threads of its own. The result has the same
//           bits for any number of threads.
// Errors    See make_grid().
// Accuracy  For the gate of a cell, the range is within 0.15 m of the model. The weights of a cell
//           equal the model's weights for a beam up to 0.25 m higher or lower, with edges up to 1 m
//           higher or lower (grid/sweep/polar_sweep.h). tests/grid/gridder_oracle_test.cpp enforces
//           both for whole grids. docs/geometry.md has the error of the model itself.
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
    double beam_width_deg = 0;  // half-power; 0: beam_width_of() of the site
    int threads = 1;
    Method method;
    // The profile of the air for traced beams; none: the exponential reference atmosphere.
    std::optional<RefractivityProfile> profile = std::nullopt;
    // The choice among equally good sweeps of an elevation: the newest, or the nearest to the frame
    // time (stormcellar/grid/sweep_choice.h).
    enum class Repeats { newest, nearest_in_time };
    Repeats repeats = Repeats::newest;
    // The instant for which the grid is made; none: the start of the volume.
    std::optional<UtcTime> frame_time = std::nullopt;
    // The details to compute besides the values. Other details are neither computed nor allocated.
    DetailSet details = {};
};

// Returns the half-power beam width: 0.55 degrees for a TDWR in the station table, else 0.95
// (WSR-88D).
[[nodiscard]] double beam_width_of(std::string_view icao);

// Returns the sweeps that make_grid() uses with these options.
[[nodiscard]] std::vector<ChosenSweep> sweeps_to_grid(const level2::Volume& volume,
                                                      const SitePosition& site,
                                                      const GridderOptions& options);

// Grids a volume. The caller fills in provenance.source_files and .partial. Errors: not_found if
// the volume has no sweep with the moment; bad_argument for a geometry made for another place, an
// antenna altitude beyond 10 km, a beam width outside 0 to 5 degrees, averaging in Z of another
// moment than REF, an implausible frame time, or fewer than one thread.
[[nodiscard]] Result<Grid> make_grid(const level2::Volume& volume, const SitePosition& site,
                                     const ColumnGeometry& geometry, const GridderOptions& options);

}  // namespace stormcellar::grid
