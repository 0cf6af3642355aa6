// render/view_geometry.h -- where points of the grid are in the picture.
//
// Drawn space: x east, y north and z = height above sea level times the vertical exaggeration, in
// metres from the grid's centre (of a latitude-longitude grid as its centre has them, see
// GridSpec::cell_width_m()). The camera is orthographic; it looks at the middle of the box
// that holds the grid (the grid's cells, and the ground below them). At zoom 1 that box just fits
// into the picture.
// Pixels: (0, 0) is the top left corner of the picture, (0.5, 0.5) the middle of its first pixel.
// Thread contract: immutable.
#pragma once

#include <array>
#include <optional>

#include "grid/grid_spec.h"
#include "render/scene.h"

namespace stormcellar::render {

using Vec3 = std::array<double, 3>;

struct Pixel {
    double x = 0, y = 0;
};

struct GroundPoint {
    double x_m = 0, y_m = 0;
};

class ViewGeometry {
  public:
    ViewGeometry(const grid::GridSpec& spec, const Camera& camera, double vertical_exaggeration,
                 int width, int height);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] double exaggeration() const { return exaggeration_; }
    [[nodiscard]] double metres_per_pixel() const { return metres_per_pixel_; }

    // Unit vectors of drawn space: to the right and up in the picture, and away from the camera.
    [[nodiscard]] const Vec3& right() const { return right_; }
    [[nodiscard]] const Vec3& up() const { return up_; }
    [[nodiscard]] const Vec3& forward() const { return forward_; }

    [[nodiscard]] Pixel project(double x_m, double y_m, double height_m) const;
    // The point of drawn space under a pixel at a depth along forward().
    [[nodiscard]] Vec3 point(Pixel pixel, double depth_m) const;
    // Where the ground lies under a pixel; none when the view runs along the ground.
    [[nodiscard]] std::optional<GroundPoint> ground(Pixel pixel) const;

    // Depths between which the box of the grid's cells lies.
    [[nodiscard]] double near_m() const { return near_m_; }
    [[nodiscard]] double far_m() const { return far_m_; }

    // The box: half widths, lower and upper height of its cells (not exaggerated), ground height.
    [[nodiscard]] double half_x_m() const { return half_x_m_; }
    [[nodiscard]] double half_y_m() const { return half_y_m_; }
    [[nodiscard]] double bottom_m() const { return bottom_m_; }
    [[nodiscard]] double top_m() const { return top_m_; }
    [[nodiscard]] double ground_m() const { return ground_m_; }

  private:
    int width_, height_;
    double exaggeration_;
    double half_x_m_, half_y_m_, bottom_m_, top_m_, ground_m_;
    Vec3 right_{}, up_{}, forward_{}, middle_{};
    double metres_per_pixel_ = 1;
    double near_m_ = 0, far_m_ = 0;
};

// Half a level's spacing beyond the first and last level: where the grid's cells end.
struct HeightRange {
    double bottom_m = 0, top_m = 0;
};
[[nodiscard]] HeightRange height_range(const grid::GridSpec& spec);

}  // namespace stormcellar::render
