// stormcellar/render/view_geometry.h -- where points of the grid are in the picture.
//
// Drawn space: x east, y north and z = height above sea level times the vertical exaggeration, in
// metres from the grid's middle (of a latitude-longitude grid as its centre has them, see
// GridSpec::cell_width_m()). Where the earth is drawn curved, a point r from the middle lies
// r^2 / (2 R) lower, R = 6,371 km, which is also exaggerated: the parabola is off the sphere by
// less than 1 % of that drop within 1,000 km.
// The camera is orthographic or a perspective one. Without a place of its own it looks at the
// middle of the box that holds the grid (the grid's cells, and the ground below them); at zoom 1
// that box just fits into the picture. Pixels: (0, 0) is the top left corner of the picture, (0.5,
// 0.5) the middle of its first pixel. Depth: metres along forward(), from the camera (perspective)
// or from the middle (orthographic). Thread contract: immutable.
#pragma once

#include <array>
#include <optional>

#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/render/scene.h"

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
                 int width, int height, bool curved_earth = false);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] double exaggeration() const { return exaggeration_; }
    [[nodiscard]] bool is_perspective() const { return focal_pixels_ > 0; }
    // At the middle of the box.
    [[nodiscard]] double metres_per_pixel() const { return metres_per_pixel_; }
    [[nodiscard]] double metres_per_pixel(double depth_m) const {
        return is_perspective() ? depth_m / focal_pixels_ : metres_per_pixel_;
    }

    // Unit vectors of drawn space: to the right and up in the picture, and away from the camera.
    [[nodiscard]] const Vec3& right() const { return right_; }
    [[nodiscard]] const Vec3& up() const { return up_; }
    [[nodiscard]] const Vec3& forward() const { return forward_; }

    // Not a number for what lies behind a perspective camera.
    [[nodiscard]] Pixel project(double x_m, double y_m, double height_m) const;
    [[nodiscard]] Pixel project(const Vec3& drawn) const;
    [[nodiscard]] double depth_of(const Vec3& drawn) const;
    // The point of drawn space under a pixel at a depth: linear in the depth.
    [[nodiscard]] Vec3 point(Pixel pixel, double depth_m) const;
    // How far point() moves for a metre of depth.
    [[nodiscard]] Vec3 along(Pixel pixel) const;
    // Where the ground lies under a pixel, also beyond the grid; none where there is sky.
    [[nodiscard]] std::optional<GroundPoint> ground(Pixel pixel) const;

    // Depths between which the box of the grid's cells lies, in front of the camera. The farther is
    // always the larger.
    [[nodiscard]] double near_m() const { return near_m_; }
    [[nodiscard]] double far_m() const { return far_m_; }

    // The box: half widths, lower and upper height of its cells (not exaggerated), ground height.
    [[nodiscard]] double half_x_m() const { return half_x_m_; }
    [[nodiscard]] double half_y_m() const { return half_y_m_; }
    [[nodiscard]] double bottom_m() const { return bottom_m_; }
    [[nodiscard]] double top_m() const { return top_m_; }
    [[nodiscard]] double ground_m() const { return ground_m_; }

    // What the drawn earth's curve takes off a height, not exaggerated; and its factor of r^2.
    [[nodiscard]] double drop_m(double x_m, double y_m) const {
        return drop_per_m2_ * (x_m * x_m + y_m * y_m);
    }
    [[nodiscard]] double drop_per_m2() const { return drop_per_m2_; }
    // Height above sea level of a point of drawn space.
    [[nodiscard]] double height_at(const Vec3& drawn) const {
        return drawn[2] / exaggeration_ + drop_m(drawn[0], drawn[1]);
    }

  private:
    void fit_picture(const Camera& camera);
    void place_eye(const Camera& camera);
    void find_depths();
    [[nodiscard]] std::array<Vec3, 8> corners(double low_m) const;

    int width_, height_;
    double exaggeration_;
    double half_x_m_, half_y_m_, bottom_m_, top_m_, ground_m_;
    double drop_per_m2_;
    Vec3 right_{}, up_{}, forward_{}, middle_{};
    Vec3 eye_{};               // where depth is 0: the camera, or the middle
    double focal_pixels_ = 0;  // 0: orthographic
    double metres_per_pixel_ = 1;
    double near_m_ = 0, far_m_ = 0;
};

// Half a level's spacing beyond the first and last level: where the grid's cells end.
struct HeightRange {
    double bottom_m = 0, top_m = 0;
};
[[nodiscard]] HeightRange height_range(const grid::GridSpec& spec);

}  // namespace stormcellar::render
