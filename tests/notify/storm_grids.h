// tests/notify/storm_grids.h -- a cache with grids of one storm, which moves to the east.
#pragma once

#include <string>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::testing {

// The radar, which is also the center of the grids.
inline constexpr grid::GeoPoint storm_center{35.0, -97.0};
inline constexpr double storm_speed_mps = 15;

struct StormGrid {
    double east_km = 0;       // of the storm from the center
    bool is_partial = false;  // of a volume that has not ended
};

// Writes a grid of 100 x 60 x 16 cells of 1 km for the area, with one storm of 60 dBZ whose echo of
// 35 dBZ is about 8 km wide and 11 km high.
void commit_storm(const std::filesystem::path& cache, const std::string& area, UtcTime time,
                  const StormGrid& storm);

// Writes `count` grids, 5 minutes apart, the last at `newest`. In the last grid, the storm is
// `east_km` east of the center.
void commit_moving_storm(const std::filesystem::path& cache, const std::string& area,
                         UtcTime newest, int count, double east_km);

}  // namespace stormcellar::testing
