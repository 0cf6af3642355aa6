// grid/judge/audit.h -- compares a finished grid with the gates that it was made from.
//
// The audit samples gates of the sweeps that were gridded. It computes the position of each gate
// from the beam of the grid's method and from the radial's own azimuth and elevation, without the
// gridder's tables. Then it reads the grid at that position and subtracts the gate. So it measures
// the joint effect of cells, levels, quantization, beam table and frame, and of mistakes in any of
// them. The audit needs no exact grid for comparison: a grid that is turned or shifted disagrees
// with its own gates.
//
// Grid      Between cells the grid is trilinear, by the status rule of docs/geometry.md over the
//           eight cells around the gate. (The nearest cell alone may be up to 0.9 km away in a grid
//           of 1 km.) Values are in the unit of the moment. REF is always in dB, with no echo at
//           the gate's detection limit. Values of VEL and PHI differ by the shorter way around
//           their circle.
// Gates     Every n-th radial and every n-th gate, from the first on. The steps determine n, so the
//           gates are the same for any number of threads. Gates beyond the centers of the outermost
//           cells are not used.
// Result    For each sweep and class of ranges: the RMS and the mean of grid minus gate, in the
//           unit of the moment, over gates that have a value where the grid has one. Separately:
//           how often the statuses agree. The result describes this grid and this volume; it is no
//           bound. The grid smooths the gates between levels and columns, including their noise,
//           and neighboring gates of a radar differ by 2.6 dB.
// Cost      Half the time of gridding, in proportion to the number of gates. For a grid of 460 x
//           460 x 32 cells and one thread of a busy machine, the audit takes 19 to 29 ms if the
//           grid is about the site, and 24 to 39 ms if not.
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
    double azimuth_step_deg = 5;  // between sampled radials; a very small step samples all
    double range_step_m = 1500;   // between sampled gates; a very small step samples all
    int threads = 1;
    // Columns made for the site, for the spec of the grid and for audit_reach_m. If null, audit()
    // makes them.
    const SiteColumns* columns = nullptr;
};

// The slant ranges at which one class ends and the next begins. The last class has no end.
inline constexpr std::array audit_range_borders_m = {60e3, 120e3, 180e3, 240e3};

struct Audit {
    // Sorted by elevation, then range. Classes that have no gates are left out.
    std::vector<AuditRow> rows;
    // Numbers of gates, by their status (first index, a CellStatus) and the grid's status there
    // (second index).
    std::array<std::array<std::uint64_t, cell_status_count>, cell_status_count> states{};
};

// Audits a grid. It must have been made with the moment, beam, profile and choice of sweeps in
// `gridded`. Errors: not_found if the volume has no sweep with the moment; bad_argument for steps
// or threads that are not positive.
[[nodiscard]] Result<Audit> audit(const BrickView& grid, const level2::Volume& volume,
                                  const SitePosition& site, const GridderOptions& gridded,
                                  const AuditOptions& options = {});

}  // namespace stormcellar::grid
