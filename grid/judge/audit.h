// grid/judge/audit.h -- a virtual radar scans a finished grid and compares it with the gates.
//
// For gates of the sweeps that were gridded: where the gate is (the beam that the grid was made
// with, each radial's own azimuth and elevation, no tables of the gridder's), what the grid holds
// there, and how far that is from the gate. So it sees what cells, levels, quantisation, the beam's
// table, the frame and any mistake in them do to the data together, with no exact form to believe
// in: a grid that is turned or shifted disagrees with its own gates.
// Grid     between cells trilinear: by the status rule of docs/geometry.md over the eight cells
//          around the gate, values in the moment's unit (REF always in dB, no echo at the gate's
//          detection limit), VEL and PHI around the gate's value on their circle. Not the nearest
//          cell: it is up to 0.9 km off in a grid of 1 km, which would count as the grid's error.
// Gates    every so many radials and gates, as the steps say, from the first; the same whatever the
//          number of threads. Gates beyond the outermost cells' centres are left out.
// Result   RMS and mean of grid minus gate in the moment's unit, for each sweep and range class,
//          over gates that have a value where the grid has one; how often states agree, apart.
//          It is a measure of this grid against this volume, and no bound: gates between levels and
//          columns are smoothed, noise included (neighbouring gates of a radar differ by 2.6 dB).
// Cost     half of what gridding takes: 19 to 29 ms for 460 x 460 x 32 cells about the site, one
//          thread of a busy machine, 24 to 39 ms off it; in proportion to the gates sampled.
// Threads  a pure function; the same bits for any number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grid/place/site_columns.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/audit_row.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

// No gate beyond this is looked at.
inline constexpr double audit_reach_m = 500e3;

struct AuditOptions {
    double azimuth_step_deg = 5;  // between sampled radials; at least each one
    double range_step_m = 1500;   // between sampled gates; at least each one
    int threads = 1;
    // Made before for the site and the grid's spec, with audit_reach_m; else it is made in the
    // call.
    const SiteColumns* columns = nullptr;
};

// Slant ranges where a class ends and the next begins; the last one has no end.
inline constexpr std::array audit_range_borders_m = {60e3, 120e3, 180e3, 240e3};

struct Audit {
    std::vector<AuditRow> rows;  // by rising elevation and range; classes without gates left out
    // How many gates of a status (first index, a CellStatus) lie where the grid has another.
    std::array<std::array<std::uint64_t, 4>, 4> states{};
};

// `gridded` says how the grid was made: moment, beam, profile and choice of sweeps count.
// Errors: not_found when the volume has no sweep with the moment; bad_argument for steps or threads
// that are not positive.
[[nodiscard]] Result<Audit> audit(const BrickView& grid, const level2::Volume& volume,
                                  const SitePosition& site, const GridderOptions& gridded,
                                  const AuditOptions& options = {});

}  // namespace stormcellar::grid
