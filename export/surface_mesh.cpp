#include "export/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "stormcellar/level2/moment.h"

namespace stormcellar::surfaces {
namespace {

using grid::CellStatus;

constexpr std::uint32_t no_point = std::numeric_limits<std::uint32_t>::max();

Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
float square(const Vector& a) {
    return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

// Reads how far a cell is inside the surface: 0 or more inside, below 0 outside, NaN if unknown.
class Depths {
  public:
    Depths(const grid::Grid& grid, double value)
        : grid_(grid),
          value_(static_cast<float>(value)),
          sign_(encloses_below(grid.moment, value) ? -1.0F : 1.0F) {
        float weakest = std::numeric_limits<float>::infinity();
        for (std::size_t cell = 0; cell < grid.values.size(); ++cell) {
            if (grid.status[cell] == CellStatus::value)
                weakest = std::min(weakest, sign_ * (grid.values[cell] - value_));
        }
        // If all values are inside, let air without echo still be outside.
        no_echo_ = std::min(weakest, -std::numeric_limits<float>::epsilon());
        if (!std::isfinite(no_echo_)) no_echo_ = -1;
    }

    [[nodiscard]] float at(int ix, int iy, int iz) const {
        const std::size_t cell = grid_.spec.index(ix, iy, iz);
        switch (grid_.status[cell]) {
            case CellStatus::value:
                return sign_ * (grid_.values[cell] - value_);
            case CellStatus::no_echo:
                return no_echo_;
            case CellStatus::not_seen:
            case CellStatus::range_folded:
            case CellStatus::ambiguous:
                break;
        }
        return std::numeric_limits<float>::quiet_NaN();
    }

  private:
    const grid::Grid& grid_;
    float value_, sign_, no_echo_ = -1;
};

// A corner or an edge of a box: offsets in columns, rows and levels.
struct Corner {
    int x, y, z;
};
constexpr std::array<Corner, 8> corners_of_box = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};
// The bit that differs between the numbers of two corners is the axis of their edge.
constexpr std::array<std::array<int, 2>, 12> edges_of_box = {{{0, 1},
                                                              {2, 3},
                                                              {4, 5},
                                                              {6, 7},
                                                              {0, 2},
                                                              {1, 3},
                                                              {4, 6},
                                                              {5, 7},
                                                              {0, 4},
                                                              {1, 5},
                                                              {2, 6},
                                                              {3, 7}}};

using Place = std::array<double, 3>;  // in a box, 0 to 1 along each axis

// Finds the mean of the crossings of a box's edges. Returns false if the surface does not cross the
// box, or if a corner is unknown.
bool find_crossing(const std::array<float, 8>& depth, Place& place) {
    place = {0, 0, 0};
    int crossings = 0;
    for (const float of_corner : depth)
        if (std::isnan(of_corner)) return false;
    for (const auto& [from, to] : edges_of_box) {
        const double a = depth[static_cast<std::size_t>(from)];
        const double b = depth[static_cast<std::size_t>(to)];
        if ((a >= 0) == (b >= 0)) continue;
        const double share = a / (a - b);
        const Corner& first = corners_of_box[static_cast<std::size_t>(from)];
        const Corner& last = corners_of_box[static_cast<std::size_t>(to)];
        place[0] += first.x + share * (last.x - first.x);
        place[1] += first.y + share * (last.y - first.y);
        place[2] += first.z + share * (last.z - first.z);
        ++crossings;
    }
    if (crossings == 0) return false;
    for (double& part : place)
        part /= crossings;
    return true;
}

// Makes the surface row by row. Holds the points of two rows of boxes.
class SurfaceNet {
  public:
    SurfaceNet(const grid::Grid& grid, double value, double height_scale)
        : spec_(grid.spec),
          depths_(grid, value),
          height_scale_(height_scale),
          before_(row_size(), no_point),
          row_(row_size(), no_point) {}

    SurfaceMesh make() {
        for (int iy = 0; iy + 1 < spec_.ny; ++iy) {
            std::swap(before_, row_);
            std::ranges::fill(row_, no_point);
            place_points(iy);
            join_points(iy);
        }
        add_normals();
        return std::move(mesh_);
    }

  private:
    [[nodiscard]] std::size_t row_size() const {
        return static_cast<std::size_t>(spec_.nx) * spec_.levels_m.size();
    }
    [[nodiscard]] std::size_t place(int ix, int iz) const {
        return static_cast<std::size_t>(ix) * spec_.levels_m.size() + static_cast<std::size_t>(iz);
    }

    void place_points(int iy) {
        for (int ix = 0; ix + 1 < spec_.nx; ++ix) {
            for (int iz = 0; iz + 1 < spec_.nz(); ++iz) {
                std::array<float, 8> depth{};
                for (std::size_t at = 0; at < depth.size(); ++at) {
                    const Corner& corner = corners_of_box[at];
                    depth[at] = depths_.at(ix + corner.x, iy + corner.y, iz + corner.z);
                }
                Place crossing{};
                if (!find_crossing(depth, crossing)) continue;
                row_[place(ix, iz)] = static_cast<std::uint32_t>(mesh_.points.size());
                const double bottom_m = spec_.levels_m[static_cast<std::size_t>(iz)];
                const double top_m = spec_.levels_m[static_cast<std::size_t>(iz) + 1];
                const double east_m = spec_.x_m(ix) + crossing[0] * spec_.cell_width_m();
                const double north_m = spec_.y_m(iy) + crossing[1] * spec_.cell_height_m();
                const double up_m = (bottom_m + crossing[2] * (top_m - bottom_m)) * height_scale_;
                mesh_.points.push_back({static_cast<float>(east_m), static_cast<float>(up_m),
                                        static_cast<float>(-north_m)});
            }
        }
    }

    // Joins the points about each edge that begins in row iy: along x and z in this row, and along
    // y to the next row. Points go counterclockwise as seen from the edge's end.
    void join_points(int iy) {
        for (int ix = 0; ix + 1 < spec_.nx; ++ix) {
            for (int iz = 0; iz + 1 < spec_.nz(); ++iz) {
                const float here = depths_.at(ix, iy, iz);
                if (std::isnan(here)) continue;
                if (iy > 0 && iz > 0)
                    add_if_crossed(here, depths_.at(ix + 1, iy, iz),
                                   {before_[place(ix, iz - 1)], row_[place(ix, iz - 1)],
                                    row_[place(ix, iz)], before_[place(ix, iz)]});
                if (ix > 0 && iz > 0)
                    add_if_crossed(here, depths_.at(ix, iy + 1, iz),
                                   {row_[place(ix - 1, iz - 1)], row_[place(ix - 1, iz)],
                                    row_[place(ix, iz)], row_[place(ix, iz - 1)]});
                if (ix > 0 && iy > 0)
                    add_if_crossed(here, depths_.at(ix, iy, iz + 1),
                                   {before_[place(ix - 1, iz)], before_[place(ix, iz)],
                                    row_[place(ix, iz)], row_[place(ix - 1, iz)]});
            }
        }
    }

    void add_if_crossed(float here, float there, std::array<std::uint32_t, 4> points) {
        if ((here >= 0) == (there >= 0)) return;
        if (std::ranges::find(points, no_point) != points.end()) return;
        if (here < 0) std::swap(points[1], points[3]);
        const auto& at = mesh_.points;
        const float first = square(minus(at[points[0]], at[points[2]]));
        const float second = square(minus(at[points[1]], at[points[3]]));
        if (first <= second) {
            add_triangle(points[0], points[1], points[2]);
            add_triangle(points[0], points[2], points[3]);
        } else {
            add_triangle(points[1], points[2], points[3]);
            add_triangle(points[1], points[3], points[0]);
        }
    }

    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto& at = mesh_.points;
        if (at[a] == at[b] || at[b] == at[c] || at[c] == at[a]) return;
        mesh_.corners.insert(mesh_.corners.end(), {a, b, c});
    }

    // Adds up the normals of the triangles at each point, weighted by their areas.
    void add_normals() {
        std::vector<Vector>& normals = mesh_.normals;
        normals.assign(mesh_.points.size(), {0, 0, 0});
        for (std::size_t at = 0; at < mesh_.corners.size(); at += 3) {
            const Vector& a = mesh_.points[mesh_.corners[at]];
            const Vector& b = mesh_.points[mesh_.corners[at + 1]];
            const Vector& c = mesh_.points[mesh_.corners[at + 2]];
            const Vector normal = cross(minus(b, a), minus(c, a));
            for (std::size_t corner = at; corner < at + 3; ++corner) {
                Vector& sum = normals[mesh_.corners[corner]];
                for (std::size_t axis = 0; axis < 3; ++axis)
                    sum[axis] += normal[axis];
            }
        }
        for (Vector& normal : normals) {
            const float length = std::sqrt(square(normal));
            if (!(length > 0)) {
                normal = {0, 1, 0};
                continue;
            }
            for (float& part : normal)
                part /= length;
        }
    }

    const grid::GridSpec& spec_;
    const Depths depths_;
    const double height_scale_;
    std::vector<std::uint32_t> before_, row_;  // points of the boxes at (column, level)
    SurfaceMesh mesh_;
};

}  // namespace

bool encloses_below(level2::Moment moment, double value) {
    return value < 0 && level2::facts_of(moment).is_signed;
}

SurfaceMesh surface_of(const grid::Grid& grid, double value, double height_scale) {
    return SurfaceNet(grid, value, height_scale).make();
}

}  // namespace stormcellar::surfaces
