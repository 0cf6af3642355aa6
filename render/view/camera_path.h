// render/view/camera_path.h -- computes the path of a camera through a loop, between places that a
// user names.
//
// A CameraKey gives the camera at an instant. Its members without a value are taken from the usual
// camera. Between two keys the camera moves smoothly, without jumps of its velocity:
//   ground plan   Catmull and Rom's curve through the places (and one through the points looked
//                 at). Its knots are at the times of the keys. Two keys at the same place hold the
//                 camera.
//   heights, tilt, zoom (its logarithm), field of view, azimuth
//                 Monotone cubics (Fritsch and Carlson 1980): between two keys they stay between
//                 the values of the keys, so that no camera dips below the lower of two keys.
//   azimuth       The shortest turn from key to key, plus `turns` whole turns.
// The camera starts and ends at rest, unless it ends where it began. Then it keeps moving, so that
// the loop can be repeated without a jolt.
//
// Units     Each member names its unit; heights are above sea level.
// Threads   A CameraPath is immutable.
// Errors    See make().
#pragma once

#include <optional>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

struct CameraKey {
    double time_s = 0;  // only the ratios of the times count
    std::optional<double> azimuth_deg, tilt_deg, zoom, field_of_view_deg;
    int turns = 0;  // whole turns since the previous key, clockwise as seen from above
    std::optional<Eye> eye, look_at;
};

// One number that varies with time: a cubic Hermite curve between its knots.
class KeyedCurve {
  public:
    enum class Shape { smooth, monotone };

    // `times` rise; there are at least two. `is_held` marks the knots at which the slope is 0. If
    // it is empty, there are no such knots.
    KeyedCurve(std::vector<double> times, std::vector<double> values, Shape shape, bool is_closed,
               const std::vector<bool>& is_held = {});
    // Returns the value at a time. Before the first knot and after the last, it is the value at
    // that knot.
    [[nodiscard]] double at(double time) const;

  private:
    std::vector<double> times_, values_, slopes_;
};

class CameraPath {
  public:
    // Makes a path. Errors: bad_argument for fewer than two keys, and for a faulty key, which the
    // message names (1 is the first). Faults are: a time that does not rise or is not finite; a
    // place, a point to look at or a field of view that some keys have and others lack; azimuth,
    // tilt or turns in keys that have both a place and a point to look at; turns of the first key;
    // values outside the ranges of a scene.
    [[nodiscard]] static Result<CameraPath> make(const std::vector<CameraKey>& keys,
                                                 const Camera& usual);

    [[nodiscard]] double duration_s() const { return times_.back() - times_.front(); }
    // Returns true if the path ends where it began.
    [[nodiscard]] bool is_closed() const { return is_closed_; }
    // Returns the camera at a share of the path's time, 0 to 1.
    [[nodiscard]] Camera at(double share) const;

  private:
    struct PlaceCurves {
        KeyedCurve x_m, y_m, height_m;
        [[nodiscard]] Eye at(double time) const {
            return {x_m.at(time), y_m.at(time), height_m.at(time)};
        }
    };
    struct Full;  // the cameras at the keys
    CameraPath(std::vector<double> times, const Full& full);
    [[nodiscard]] KeyedCurve curve(const std::vector<double>& values) const {
        return {times_, values, KeyedCurve::Shape::monotone, is_closed_};
    }
    [[nodiscard]] PlaceCurves place_curves(const std::vector<Eye>& places) const;

    std::vector<double> times_;
    bool is_closed_;
    KeyedCurve azimuth_deg_, tilt_deg_, log_zoom_, field_of_view_deg_;
    std::optional<PlaceCurves> eye_, look_at_;
};

}  // namespace stormcellar::render
