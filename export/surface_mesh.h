// export/surface_mesh.h -- finds the surface on which a gridded moment has a value; internal.
//
// Surface nets: each box of eight neighboring cells that the surface crosses gets one point, the
// mean of the crossings of the box's edges, which linear interpolation finds. Each edge that the
// surface crosses gets a quadrilateral between the points of its four boxes. So a point is within
// one cell of the value.
//
// Air without echo counts as the weakest value of the grid. A box with a cell that was not seen, or
// whose value is unknown, gets no point. So the surface is open where the radar saw nothing,
// instead of closed along a blind region. (OpenVDB's volumeToMesh makes the same surface, but
// cannot leave out boxes without moving the points beside them.)
//
// Units     Meters: x east of the grid's center, y up from mean sea level, z south, as glTF has
//           them. Rows and columns lie on the plane of the projection. A grid in degrees is drawn
//           as a plane with the size that its cells have at its center.
// Threads   Pure function.
// Errors    None. The arrays of the grid must fit its spec.
// Accuracy  Floats: 1/64 m at 230 km.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stormcellar/grid/grid.h"

namespace stormcellar::surfaces {

using Vector = std::array<float, 3>;

struct SurfaceMesh {
    std::vector<Vector> points;
    std::vector<Vector> normals;  // of length 1, toward the air that is not enclosed
    // Three points of each triangle, counterclockwise as seen from outside.
    std::vector<std::uint32_t> corners;
};

// Returns true if a surface encloses the values below `value` instead of those above it. This is so
// for negative values of moments like velocity: -30 m/s encloses strong wind toward the radar.
[[nodiscard]] bool encloses_below(level2::Moment moment, double value);

// Heights are multiplied by `height_scale`.
[[nodiscard]] SurfaceMesh surface_of(const grid::Grid& grid, double value, double height_scale);

}  // namespace stormcellar::surfaces
