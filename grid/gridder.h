// grid/gridder.h -- a decoded volume -> a Grid, by columns.
//
// All cells of a column share azimuth and arc, so each sweep is sampled once a column (nearest
// gate and radial), then values run up the column, linear in height between the beams of sweeps
// that are adjacent in the VCP. Nothing is invented: beyond half a beam width above the highest and
// below the lowest sweep, beyond the last gate, in azimuth gaps and where a cut is missing, cells
// are "not seen". The rule for mixed states is DESIGN section 5, in docs/geometry.md.
// Averaging is in dB (the moment's own unit); moments that wrap (VEL, PHI) are not averaged.
// Model: WGS84 for the site frame, a sphere of 4/3 Gaussian radius for the beam.
// Threads: the result has the same bits for any number of threads.
// Accuracy: the gate and the weights of a cell are those of the model within 0.15 m of range and
// height (tests/grid/gridder_oracle_test.cpp); the model's own error is in docs/geometry.md.
#pragma once

#include <memory>
#include <string_view>

#include "base/result.h"
#include "grid/grid.h"
#include "level2/volume.h"

namespace stormcellar::grid {

struct GridderOptions {
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0;  // half-power; 0: that of the site's radar, beam_width_of()
    int threads = 1;
};

// Half-power beam width: 0.55 degrees for a TDWR of the station table, else 0.95 (WSR-88D).
[[nodiscard]] double beam_width_of(std::string_view icao);

// Azimuth and arc from one site to every column of a spec; made once and shared between volumes.
// See grid/column_geometry.h.
class ColumnGeometry;
[[nodiscard]] Result<std::shared_ptr<const ColumnGeometry>> make_column_geometry(
    const SitePosition& site, const GridSpec& spec);

// Errors: not_found when the volume has no sweep with the moment; bad_argument for a geometry made
// for another site, a beam width that is not within 0 to 5 degrees, or no threads. The caller fills
// in provenance.source_files and .partial.
[[nodiscard]] Result<Grid> make_grid(const level2::Volume& volume, const SitePosition& site,
                                     const ColumnGeometry& geometry, const GridderOptions& options);

}  // namespace stormcellar::grid
