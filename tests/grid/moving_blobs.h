// tests/grid/moving_blobs.h -- grids of smooth echoes that drift, so that the truth is known at any
// instant.
#pragma once

#include <cmath>
#include <vector>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::grid {

// An echo whose reflectivity falls with the square of the distance, by 10 dB at the radius.
struct Blob {
    double x_km = 0, y_km = 0;  // at t = 0, relative to the center of the grid
    double radius_km = 10;
    double peak_dbz = 50;
    double east_mps = 0, north_mps = 0;
};

inline double blobs_dbz(const std::vector<Blob>& blobs, double x_km, double y_km, double t_s) {
    double most = -40;
    for (const Blob& blob : blobs) {
        const double dx = x_km - blob.x_km - blob.east_mps * t_s / 1000;
        const double dy = y_km - blob.y_km - blob.north_mps * t_s / 1000;
        const double radii = (dx * dx + dy * dy) / (blob.radius_km * blob.radius_km);
        most = std::max(most, blob.peak_dbz - 10 * radii);
    }
    return most;
}

// Returns the grid at time t_s. Cells below 0 dBZ have no echo. Cells farther than `seen_km` from
// the center are not seen.
inline Grid blob_grid(const GridSpec& spec, const std::vector<Blob>& blobs, double t_s,
                      double seen_km = 1e9) {
    Grid grid;
    grid.spec = spec;
    grid.values.resize(spec.cell_count());
    grid.status.resize(spec.cell_count());
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            const double x_km = spec.x_m(ix) / 1000, y_km = spec.y_m(iy) / 1000;
            const double dbz = blobs_dbz(blobs, x_km, y_km, t_s);
            for (int iz = 0; iz < spec.nz(); ++iz) {
                const std::size_t cell = spec.index(ix, iy, iz);
                if (std::hypot(x_km, y_km) > seen_km) continue;
                grid.status[cell] = dbz < 0 ? CellStatus::no_echo : CellStatus::value;
                if (dbz >= 0) grid.values[cell] = static_cast<float>(dbz);
            }
        }
    }
    return grid;
}

}  // namespace stormcellar::grid
