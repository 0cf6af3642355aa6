// stormcellar/render/view_geometry.h -- where points of the grid are in the picture.
//
// Drawn space  x points east, y north, and z is the height above sea level times the vertical
//              exaggeration, in meters from the middle of the grid. In a latitude-longitude grid
//              all columns have the size in meters of the column at the center
//              (GridSpec::cell_width_m()). If the earth is drawn curved, a point at the distance r
//              from the middle is r^2 / (2 R) lower, with R = 6,371 km, before the exaggeration.
//              This parabola differs from the sphere by less than 1 % of the drop within 1,000 km.
// Camera       Orthographic or perspective. A camera without an `eye` looks at the middle of the
//              box that holds the grid (the cells and the ground below them). At zoom 1 that box
//              just fits into the picture. The look_at of such a camera moves the picture and keeps
//              the scale.
// Pixels       (0, 0) is the top left corner of the picture, (0.5, 0.5) the middle of its first
//              pixel.
// Depth        Meters along forward(), from the camera (perspective) or from the middle
//              (orthographic).
// Threads      A ViewGeometry is immutable, so any thread may use it.
// Errors       None; the spec and the camera must be valid.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

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

// The ground under the middles of a row of pixels; NaN where there is sky.
struct GroundRow {
    std::vector<double> x_m, y_m;
    [[nodiscard]] bool is_sky(std::size_t x) const { return std::isnan(x_m[x]); }
};

class ViewGeometry {
  public:
    ViewGeometry(const grid::GridSpec& spec, const Camera& camera, double vertical_exaggeration,
                 int width, int height, bool curved_earth = false);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] double exaggeration() const { return exaggeration_; }
    [[nodiscard]] bool is_perspective() const { return focal_pixels_ > 0; }
    // Returns the size of a pixel at the middle of the box, or at a depth.
    [[nodiscard]] double metres_per_pixel() const { return metres_per_pixel_; }
    [[nodiscard]] double metres_per_pixel(double depth_m) const {
        return is_perspective() ? depth_m / focal_pixels_ : metres_per_pixel_;
    }

    // Unit vectors of drawn space: right() points to the right in the picture, up() up in the
    // picture, and forward() away from the camera.
    [[nodiscard]] const Vec3& right() const { return right_; }
    [[nodiscard]] const Vec3& up() const { return up_; }
    [[nodiscard]] const Vec3& forward() const { return forward_; }

    // Returns the pixel of a point, or NaN if the point is behind a perspective camera.
    [[nodiscard]] Pixel project(double x_m, double y_m, double height_m) const;
    [[nodiscard]] Pixel project(const Vec3& drawn) const;
    [[nodiscard]] double depth_of(const Vec3& drawn) const;
    // Returns the point of drawn space under a pixel at a depth. The point is linear in the depth.
    [[nodiscard]] Vec3 point(Pixel pixel, double depth_m) const;
    // Returns how far point() moves for each meter of depth.
    [[nodiscard]] Vec3 along(Pixel pixel) const;
    // Returns the ground under a pixel, also beyond the grid, or none where there is sky.
    [[nodiscard]] std::optional<GroundPoint> ground(Pixel pixel) const;

    // Fills `row` with the ground under the middle of each pixel of row `y`, from left to right,
    // and reuses its memory. The numbers equal the results of ground() to the bit.
    void ground_of_row(int y, GroundRow& row) const;

    // Return the least and the largest depth of the box of the grid's cells, in front of the
    // camera. far_m() is always the larger.
    [[nodiscard]] double near_m() const { return near_m_; }
    [[nodiscard]] double far_m() const { return far_m_; }

    // Return the box: half its widths, the lowest and highest height of its cells (not
    // exaggerated), and the height of the ground.
    [[nodiscard]] double half_x_m() const { return half_x_m_; }
    [[nodiscard]] double half_y_m() const { return half_y_m_; }
    [[nodiscard]] double bottom_m() const { return bottom_m_; }
    [[nodiscard]] double top_m() const { return top_m_; }
    [[nodiscard]] double ground_m() const { return ground_m_; }

    // drop_m() returns how much the drawn curve of the earth lowers a point, not exaggerated;
    // drop_per_m2() returns the factor of r^2.
    [[nodiscard]] double drop_m(double x_m, double y_m) const {
        return drop_per_m2_ * (x_m * x_m + y_m * y_m);
    }
    [[nodiscard]] double drop_per_m2() const { return drop_per_m2_; }
    // Returns the height above sea level of a point of drawn space.
    [[nodiscard]] double height_at(const Vec3& drawn) const {
        return drawn[2] / exaggeration_ + drop_m(drawn[0], drawn[1]);
    }

  private:
    void fit_picture(const Camera& camera);
    void place_eye(const Camera& camera);
    void look_at(const Eye& point);
    void find_depths();
    [[nodiscard]] std::array<Vec3, 8> corners(double low_m) const;
    void flat_ground_of_row(Pixel first, GroundRow& row) const;

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

// Returns the camera with the azimuth and the tilt that turn it from its eye to its look_at. If the
// eye is right above or below the look_at, the azimuth does not change. A camera without an eye or
// a look_at is returned unchanged.
[[nodiscard]] Camera aimed(const Camera& camera, double vertical_exaggeration,
                           bool curved_earth = false);

// The range of heights of the cells: half a spacing beyond the first and the last level, or 1 km
// about a single level.
struct HeightRange {
    double bottom_m = 0, top_m = 0;
};
[[nodiscard]] HeightRange height_range(const grid::GridSpec& spec);

}  // namespace stormcellar::render
