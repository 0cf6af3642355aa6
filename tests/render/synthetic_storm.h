// tests/render/synthetic_storm.h -- makes grids for tests of the renderer from functions of the
// place.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "render/image/layer.h"
#include "render/volume/slicer.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/render/render.h"

namespace stormcellar::render {

inline grid::GridSpec small_spec(int n, int levels, double spacing_m = 1000,
                                 double level_spacing_m = 500) {
    grid::GridSpec spec;
    spec.center_latitude_deg = 35;
    spec.center_longitude_deg = -97;
    spec.spacing_m = spacing_m;
    spec.nx = spec.ny = n;
    for (int i = 0; i < levels; ++i)
        spec.levels_m.push_back(level_spacing_m * (i + 1));
    return spec;
}

// Returns small_spec() in degrees. Cells are narrower from west to east than from south to north.
inline grid::GridSpec small_degrees_spec(int n, int levels) {
    grid::GridSpec spec = small_spec(n, levels);
    spec.projection = grid::Projection::latitude_longitude;
    spec.spacing_m = 0;
    spec.spacing_deg = 0.01;
    return spec;
}

// Returns the spec in another projection, with about the same spacing.
inline grid::GridSpec in_projection(grid::GridSpec spec, grid::Projection projection) {
    spec.projection = projection;
    if (spec.in_degrees()) {
        spec.spacing_deg = spec.spacing_m / 111e3;
        spec.spacing_m = 0;
    }
    if (grid::facts_of(projection).takes_parallels) spec.parallels_deg = {30, 46};
    return spec;
}

// Returns a spec of two levels in any projection, with a spacing near `spacing_m`.
inline grid::GridSpec projected_spec(grid::Projection projection, double latitude_deg,
                                     double longitude_deg, int nx, int ny, double spacing_m) {
    grid::GridSpec spec = small_spec(nx, 2, spacing_m);
    spec.ny = ny;
    spec.center_latitude_deg = latitude_deg;
    spec.center_longitude_deg = longitude_deg;
    return in_projection(spec, projection);
}

struct Cell {
    grid::CellStatus status = grid::CellStatus::no_echo;
    float value = 0;
};
inline Cell valued(double dbz) {
    return {grid::CellStatus::value, static_cast<float>(dbz)};
}

// Calls `cell` with the indices of each cell.
inline grid::Grid make_grid_of(const grid::GridSpec& spec,
                               const std::function<Cell(int, int, int)>& cell) {
    grid::Grid grid;
    grid.spec = spec;
    grid.values.resize(spec.cell_count());
    grid.status.resize(spec.cell_count());
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            for (int iz = 0; iz < spec.nz(); ++iz) {
                const Cell c = cell(ix, iy, iz);
                grid.status[spec.index(ix, iy, iz)] = c.status;
                grid.values[spec.index(ix, iy, iz)] = c.value;
            }
        }
    }
    return grid;
}

inline grid::BrickGrid bricks_of(const grid::Grid& grid, int code_bytes = 1,
                                 bool has_ambiguous = false) {
    return grid::BrickGrid::from(grid,
                                 {code_bytes, -32, code_bytes == 1 ? 0.5F : 0.01F, has_ambiguous});
}

// Returns a cell of a storm without any symmetry, as a synthetic radar sees it: a leaning core with
// an anvil to the northeast, a line to the southwest, a cone of silence, and a missing sector.
inline Cell storm_cell(const grid::GridSpec& spec, int ix, int iy, int iz) {
    const double x = spec.x_m(ix) / 1000;
    const double y = spec.y_m(iy) / 1000;
    const double z = spec.levels_m[static_cast<std::size_t>(iz)] / 1000;
    const double range = std::hypot(x, y);
    const double beam_bottom = range * std::tan(0.3 / 57.3) + range * range / 17000;
    const double beam_top = 0.1 + range * std::tan(20 / 57.3);
    const bool missing_sector = x > 0 && y < 0 && std::abs(std::atan2(x, -y) - 0.6) < 0.07;
    if (z < beam_bottom || z > beam_top || range > 300 || missing_sector) {
        return {grid::CellStatus::not_seen, 0};
    }
    const auto blob = [&](double cx, double cy, double cz, double rx, double ry, double rz) {
        return std::exp(-std::pow((x - cx) / rx, 2) - std::pow((y - cy) / ry, 2) -
                        std::pow((z - cz) / rz, 2));
    };
    const double lean = 0.8 * z;
    double dbz = 70 * blob(60 + lean, 40 + lean, 5, 14, 12, 7);
    dbz = std::max(dbz, 42 * blob(95, 80, 11, 55, 35, 2.2));
    dbz = std::max(dbz, 58 * blob(40 + lean, 22, 3, 6, 14, 4));
    const double along = (x + y) / 1.414 + 130;
    const double across = (x - y) / 1.414 + 8 * std::sin(along / 14);
    dbz = std::max(dbz, (48 + 8 * std::sin(along / 9)) *
                            std::exp(-std::pow(across / 7, 2) - std::pow(along / 80, 2) -
                                     std::pow((z - 3) / 5, 2)));
    dbz = std::max(dbz, 24 * blob(-90, 90, 3, 60, 45, 2.5));
    if (dbz < 2) return {grid::CellStatus::no_echo, 0};
    return valued(dbz);
}

inline grid::Grid storm_grid(const grid::GridSpec& spec) {
    grid::Grid grid =
        make_grid_of(spec, [&](int ix, int iy, int iz) { return storm_cell(spec, ix, iy, iz); });
    grid.sites = {{"KTLX", spec.center_latitude_deg, spec.center_longitude_deg, 384}};
    return grid;
}

inline FrameFacts facts_of(const grid::Grid& grid) {
    return {"KTLX", level2::Moment::ref, parse_compact("19990503_235621").value(), grid.sites,
            false};
}

// Draws only the volume, with the slicer.
inline Layer sliced(const grid::BrickView& bricks, const ViewGeometry& view,
                    const VolumeOptions& options, int threads = 2,
                    const ColorTable& table = nws_reflectivity()) {
    return VolumeSlicer(table, bricks.quantization, view, options).draw(bricks, threads);
}

// Returns red, green, blue and opacity of a pixel of the layer.
inline std::array<double, 4> pixel_of(const Layer& layer, int x, int y) {
    const std::size_t at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(layer.width) +
                            static_cast<std::size_t>(x)) *
                           4;
    return {static_cast<double>(layer.rgba[at]), static_cast<double>(layer.rgba[at + 1]),
            static_cast<double>(layer.rgba[at + 2]), static_cast<double>(layer.rgba[at + 3])};
}

}  // namespace stormcellar::render
