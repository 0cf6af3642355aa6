// tests/retrieve/cells_scene.h -- simulated volumes of storms, gridded by the real gridder, for the
// tests of storm cells.
//
// The radar KTLX is at 35.333 N 97.278 W. A volume has eight sweeps and takes 170 s. Grids have
// columns of 1 km and levels of 500 m.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/retrieve/storm_cells.h"
#include "synth/synth_scene.h"

namespace stormcellar::retrieve {

// A storm of 55 dBZ whose echo of 35 dBZ has two thirds of its radius.
struct SceneStorm {
    double x_km = 0, y_km = 0, east_mps = 0, north_mps = 0, radius_km = 12, peak_dbz = 55;
};

inline constexpr double scene_interval_s = 300;

// Returns a scene of storms. `more` is TOML text with other features. Throws if it is not valid.
[[nodiscard]] synth::Scene cells_scene(const std::vector<SceneStorm>& storms,
                                       const std::string& more = "");
// Observes and grids volume `number`, of 240 x 240 columns about the radar.
[[nodiscard]] grid::BrickGrid gridded_scene(const synth::Scene& scene, int number);
// Returns the scans of the first volumes, with the motion of the echo.
[[nodiscard]] std::vector<CellScan> scene_scans(const synth::Scene& scene, int volumes);
// Returns the place of a storm at the start of a volume.
[[nodiscard]] grid::GeoPoint storm_place(const synth::Scene& scene, const SceneStorm& storm,
                                         int number);
[[nodiscard]] double between_m(grid::GeoPoint a, grid::GeoPoint b);

}  // namespace stormcellar::retrieve
