// grid/gridder.h -- a decoded volume -> a Grid, by columns.
//
// All cells of a column share azimuth and arc, so each sweep is sampled once a column (nearest
// gate and radial), then values run up the column, linear in height between the beams of sweeps
// that are adjacent in the VCP. Nothing is invented: beyond half a beam width above the highest and
// below the lowest sweep, beyond the last gate, in azimuth gaps and where a cut is missing, cells
// are "not seen". The rule for mixed states is DESIGN section 5, in docs/geometry.md.
// Averaging is in dB (the moment's own unit).
// Model: WGS84 for the site frame, a sphere of 4/3 Gaussian radius for the beam.
// Threads: the result has the same bits for any number of threads.
#pragma once

#include <memory>

#include "base/result.h"
#include "grid/grid.h"
#include "level2/volume.h"

namespace stormcellar::grid {

struct GridderOptions {
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0.95;  // half-power, of WSR-88D; TDWR 0.55
    int threads = 1;
};

// Azimuth and arc from one site to every column of a spec; made once and shared between volumes.
class ColumnGeometry;
[[nodiscard]] Result<std::shared_ptr<const ColumnGeometry>> make_column_geometry(
    const SitePosition& site, const GridSpec& spec);

// Errors: not_found when the volume has no sweep with the moment; bad_argument for a bad spec or a
// geometry made for another site. The caller fills in provenance.source_files and .partial.
[[nodiscard]] Result<Grid> make_grid(const level2::Volume& volume, const SitePosition& site,
                                     const ColumnGeometry& geometry, const GridderOptions& options);

}  // namespace stormcellar::grid
