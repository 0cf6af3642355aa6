// grid/judge/audit.h -- compares a finished grid with the gates that it was made from.
//
// The audit samples gates of the sweeps that were gridded. It computes the position of each gate
// from the beam of the grid's method and the radial's own azimuth and elevation, without the
// gridder's tables. Then it reads the grid at that position and subtracts the gate. So the audit
// measures the joint effect of cells, levels, quantization, beam table and frame, and of mistakes
// in any of them. The audit needs no exact grid for comparison, because a grid that is turned or
// shifted disagrees with its own gates.
//
// Grid      Between cells the grid is trilinear, by the status rule of docs/geometry.md over the
//           eight cells around the gate, because the nearest cell may be up to 0.9 km away in a
//           grid of 1 km. Values are in the unit of the moment (REF always in dB, with no echo at
//           the gate's detection limit). Values of VEL and PHI differ by the shorter way around
//           their circle.
// Gates     Every n-th radial and every n-th gate, from the first; the steps determine n. The gates
//           are the same for any number of threads. Gates beyond the centers of the outermost cells
//           are not used.
// Result    The RMS and the mean of grid minus gate in the unit of the moment, for each sweep and
//           class of ranges, over gates that have a value where the grid also has a value.
//           Separately, how often the statuses agree. The result measures this grid against this
//           volume and is no bound. The grid smooths gates between levels and columns, including
//           the gates' noise, and neighboring gates of a radar differ by 2.6 dB.
// Cost      Half the time of gridding, in proportion to the number of gates. For 460 x 460 x 32
//           cells with one thread of a busy machine, 19 to 29 ms about the site, and 24 to 39 ms
//           away from the site.
// Threads   A pure function, with the same bits for any number of threads.
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

// Gates beyond this range are not compared.
inline constexpr double audit_reach_m = 500e3;

struct AuditOptions {
    double azimuth_step_deg = 5;  // between sampled radials; a very small step takes all
    double range_step_m = 1500;   // between sampled gates; a very small step takes all
    int threads = 1;
    // Columns made for the site, the spec of the grid and audit_reach_m. If null, audit() makes
    // them.
    const SiteColumns* columns = nullptr;
};

// The slant ranges at which one class ends and the next begins. The last class has no end.
inline constexpr std::array audit_range_borders_m = {60e3, 120e3, 180e3, 240e3};

struct Audit {
    // by rising elevation, then range; without classes that have no gates
    std::vector<AuditRow> rows;
    // The number of gates by their status (first index, a CellStatus) and the grid's status there.
    std::array<std::array<std::uint64_t, cell_status_count>, cell_status_count> states{};
};

// Audits a grid, which was made with the moment, beam, profile and choice of sweeps in `gridded`.
// Errors: not_found if the volume has no sweep with the moment; bad_argument for steps or threads
// that are not positive.
[[nodiscard]] Result<Audit> audit(const BrickView& grid, const level2::Volume& volume,
                                  const SitePosition& site, const GridderOptions& gridded,
                                  const AuditOptions& options = {});

}  // namespace stormcellar::grid
