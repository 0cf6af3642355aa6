#include "tests/notify/storm_grids.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::testing {
namespace {

constexpr std::chrono::minutes between_grids{5};

grid::GridSpec storm_spec() {
    grid::GridSpec spec;
    spec.center_latitude_deg = storm_center.latitude_deg;
    spec.center_longitude_deg = storm_center.longitude_deg;
    spec.nx = 100;
    spec.ny = 60;
    for (int level = 1; level <= 16; ++level)
        spec.levels_m.push_back(1000.0 * level);
    return spec;
}

// Returns the reflectivity at a distance from the axis of the storm and a height.
double storm_dbz(double east_km, double north_km, double height_km) {
    const double up = std::max(0.0, height_km - 5);
    return 60 - 1.5 * (east_km * east_km + north_km * north_km) - 0.7 * up * up;
}

}  // namespace

void commit_storm(const std::filesystem::path& cache, const std::string& area, UtcTime time,
                  const StormGrid& storm) {
    grid::Grid made;
    made.spec = storm_spec();
    made.time = made.start_time = made.end_time = time;
    made.sites = {{"KTLX", storm_center.latitude_deg, storm_center.longitude_deg, 370}};
    made.provenance.stations = {"KTLX"};
    made.provenance.partial = storm.is_partial;
    made.values.assign(made.spec.cell_count(), 0.0F);
    made.status.assign(made.spec.cell_count(), grid::CellStatus::no_echo);
    for (int iz = 0; iz < 16; ++iz) {
        for (int iy = 0; iy < made.spec.ny; ++iy) {
            for (int ix = 0; ix < made.spec.nx; ++ix) {
                const double dbz = storm_dbz(ix - 49.5 - storm.east_km, iy - 29.5, iz + 1);
                if (dbz < 5) continue;
                const std::size_t at = made.spec.index(ix, iy, iz);
                made.status[at] = grid::CellStatus::value;
                made.values[at] = static_cast<float>(dbz);
            }
        }
    }
    auto store = cache::StoreWriter::open(real_file_system(), cache, false);
    ASSERT_TRUE(store) << store.error().message;
    const auto bricks = grid::BrickGrid::from(made, grid::Quantization{});
    const auto path = store->commit(area, cache::describe(made), bricks.view());
    ASSERT_TRUE(path) << path.error().message;
}

void commit_moving_storm(const std::filesystem::path& cache, const std::string& area,
                         UtcTime newest, int count, double east_km) {
    for (int i = 0; i < count; ++i) {
        const auto before = between_grids * (count - 1 - i);
        const double seconds = std::chrono::duration<double>(before).count();
        commit_storm(cache, area, newest - before,
                     {.east_km = east_km - storm_speed_mps * seconds / 1000});
    }
}

}  // namespace stormcellar::testing
