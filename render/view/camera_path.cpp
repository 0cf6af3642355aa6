#include "render/view/camera_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace stormcellar::render {
namespace {

// Returns the slope at a knot, between two straight pieces with these lengths and slopes.
double slope_between(KeyedCurve::Shape shape, double length_before, double before,
                     double length_after, double after) {
    if (shape == KeyedCurve::Shape::smooth) {
        return (before * length_after + after * length_before) / (length_before + length_after);
    }
    if (!(before * after > 0)) return 0;
    const double weight_before = 2 * length_after + length_before;
    const double weight_after = length_after + 2 * length_before;
    return (weight_before + weight_after) / (weight_before / before + weight_after / after);
}

bool is_same(const Eye& a, const Eye& b) {
    return a.x_m == b.x_m && a.y_m == b.y_m && a.height_m == b.height_m;
}

bool is_same(const std::optional<Eye>& a, const std::optional<Eye>& b) {
    return a.has_value() == b.has_value() && (!a || is_same(*a, *b));
}

// Returns the turn from one azimuth to another by the shorter way, -180 to 180 degrees.
double shortest_way_deg(double from_deg, double to_deg) {
    const double way = std::remainder(to_deg - from_deg, 360);
    return way == -180 ? 180 : way;
}

Status complain(std::size_t index, std::string_view why) {
    return fail(ErrorCode::bad_argument, "key {} of the camera {}", index + 1, why);
}

// Refuses a key that is invalid, or that contradicts the first key or the previous key.
Status check_key(const std::vector<CameraKey>& keys, std::size_t i) {
    const CameraKey& key = keys[i];
    const CameraKey& first = keys.front();
    if (!std::isfinite(key.time_s)) return complain(i, "has a time that is not finite");
    if (i > 0 && !(key.time_s > keys[i - 1].time_s)) {
        return complain(i, "does not come later than the one before it");
    }
    if (key.eye.has_value() != first.eye.has_value()) {
        return complain(i, "and the first one: either all keys have at_km, or none");
    }
    if (key.look_at.has_value() != first.look_at.has_value()) {
        return complain(i, "and the first one: either all keys have look_at_km, or none");
    }
    const bool turns_itself = key.azimuth_deg || key.tilt_deg || key.turns != 0;
    if (key.eye && key.look_at && turns_itself) {
        return complain(i,
                        "has at_km and look_at_km, which say where it looks; leave out "
                        "azimuth_deg, tilt_deg and turns");
    }
    if (i == 0 && key.turns != 0) {
        return complain(i, "has turns, which are made on the way to it, and it is the first");
    }
    return {};
}

Status check_camera(std::size_t i, const Camera& camera, const Camera& first) {
    if ((camera.field_of_view_deg > 0) != (first.field_of_view_deg > 0)) {
        return complain(i, "and the first one: either all have a field of view, or none");
    }
    Scene scene;
    scene.camera = camera;
    const Status valid = validate(scene);
    return valid ? valid : complain(i, "is impossible: " + valid.error().message);
}

}  // namespace

KeyedCurve::KeyedCurve(std::vector<double> times, std::vector<double> values, Shape shape,
                       bool is_closed, const std::vector<bool>& is_held)
    : times_(std::move(times)), values_(std::move(values)), slopes_(times_.size(), 0.0) {
    const std::size_t pieces = times_.size() - 1;
    const auto length = [&](std::size_t piece) { return times_[piece + 1] - times_[piece]; };
    const auto slope = [&](std::size_t piece) {
        return (values_[piece + 1] - values_[piece]) / length(piece);
    };
    const auto between = [&](std::size_t before, std::size_t after) {
        return slope_between(shape, length(before), slope(before), length(after), slope(after));
    };
    for (std::size_t i = 1; i < pieces; ++i)
        slopes_[i] = between(i - 1, i);
    if (is_closed) slopes_.front() = slopes_.back() = between(pieces - 1, 0);
    for (std::size_t i = 0; i < is_held.size(); ++i) {
        if (is_held[i]) slopes_[i] = 0;
    }
}

double KeyedCurve::at(double time) const {
    if (!(time > times_.front())) return values_.front();
    if (time >= times_.back()) return values_.back();
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    const auto i = static_cast<std::size_t>(after - times_.begin()) - 1;
    const double length = times_[i + 1] - times_[i];
    const double s = (time - times_[i]) / length;
    const double r = 1 - s;
    return values_[i] * (1 + 2 * s) * r * r + slopes_[i] * length * s * r * r +
           values_[i + 1] * (1 + 2 * r) * s * s - slopes_[i + 1] * length * r * s * s;
}

struct CameraPath::Full {
    std::vector<Camera> cameras;
    std::vector<double> azimuth_deg, tilt_deg, log_zoom, field_of_view_deg;
    std::vector<Eye> eye, look_at;
    bool is_closed = false;
};

CameraPath::PlaceCurves CameraPath::place_curves(const std::vector<Eye>& places) const {
    std::vector<double> x, y, height;
    for (const Eye& place : places) {
        x.push_back(place.x_m);
        y.push_back(place.y_m);
        height.push_back(place.height_m);
    }
    // If two consecutive keys have the same place, the camera is at rest at both, so that it stays
    // there.
    std::vector<bool> is_held(places.size(), false);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        if (x[i] != x[i + 1] || y[i] != y[i + 1]) continue;
        is_held[i] = is_held[i + 1] = true;
    }
    if (is_closed_ && (is_held.front() || is_held.back())) {
        is_held.front() = is_held.back() = true;
    }
    const auto smooth = KeyedCurve::Shape::smooth;
    return {{times_, x, smooth, is_closed_, is_held},
            {times_, y, smooth, is_closed_, is_held},
            curve(height)};
}

CameraPath::CameraPath(std::vector<double> times, const Full& full)
    : times_(std::move(times)),
      is_closed_(full.is_closed),
      azimuth_deg_(curve(full.azimuth_deg)),
      tilt_deg_(curve(full.tilt_deg)),
      log_zoom_(curve(full.log_zoom)),
      field_of_view_deg_(curve(full.field_of_view_deg)) {
    if (!full.eye.empty()) eye_ = place_curves(full.eye);
    if (!full.look_at.empty()) look_at_ = place_curves(full.look_at);
}

Result<CameraPath> CameraPath::make(const std::vector<CameraKey>& keys, const Camera& usual) {
    if (keys.size() < 2) {
        return fail(ErrorCode::bad_argument, "the way of a camera needs two keys or more");
    }
    Full full;
    std::vector<double> times;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const CameraKey& key = keys[i];
        if (Status fine = check_key(keys, i); !fine) return pass_on(fine);
        Camera camera = usual;
        camera.eye = key.eye ? key.eye : usual.eye;
        camera.look_at = key.look_at ? key.look_at : usual.look_at;
        camera.azimuth_deg = key.azimuth_deg.value_or(usual.azimuth_deg);
        camera.tilt_deg = key.tilt_deg.value_or(usual.tilt_deg);
        camera.zoom = key.zoom.value_or(usual.zoom);
        camera.field_of_view_deg = key.field_of_view_deg.value_or(usual.field_of_view_deg);
        if (camera.eye && camera.field_of_view_deg == 0) camera.field_of_view_deg = 60;
        full.cameras.push_back(camera);
        if (Status fine = check_camera(i, camera, full.cameras.front()); !fine) {
            return pass_on(fine);
        }
        times.push_back(key.time_s);
        full.azimuth_deg.push_back(
            i == 0 ? camera.azimuth_deg
                   : full.azimuth_deg.back() + 360.0 * key.turns +
                         shortest_way_deg(full.azimuth_deg.back(), camera.azimuth_deg));
        full.tilt_deg.push_back(camera.tilt_deg);
        full.log_zoom.push_back(std::log(camera.zoom));
        full.field_of_view_deg.push_back(camera.field_of_view_deg);
        if (camera.eye) full.eye.push_back(*camera.eye);
        if (camera.look_at) full.look_at.push_back(*camera.look_at);
    }
    const Camera& first = full.cameras.front();
    const Camera& last = full.cameras.back();
    full.is_closed = is_same(first.eye, last.eye) && is_same(first.look_at, last.look_at) &&
                     shortest_way_deg(first.azimuth_deg, last.azimuth_deg) == 0 &&
                     first.tilt_deg == last.tilt_deg && first.zoom == last.zoom &&
                     first.field_of_view_deg == last.field_of_view_deg;
    return CameraPath(std::move(times), full);
}

Camera CameraPath::at(double share) const {
    const double time = times_.front() + share * duration_s();
    Camera camera;
    camera.azimuth_deg = azimuth_deg_.at(time);
    camera.tilt_deg = tilt_deg_.at(time);
    camera.zoom = std::exp(log_zoom_.at(time));
    camera.field_of_view_deg = field_of_view_deg_.at(time);
    if (eye_) camera.eye = eye_->at(time);
    if (look_at_) camera.look_at = look_at_->at(time);
    return camera;
}

}  // namespace stormcellar::render
