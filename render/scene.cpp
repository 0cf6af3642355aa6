#include "render/scene.h"

#include <array>
#include <cmath>

#include "base/floating_point.h"

namespace stormcellar::render {
namespace {

struct Named {
    Product product;
    std::string_view name;
};
constexpr std::array<Named, 2> products = {
    {{Product::volume, "volume"}, {Product::composite, "composite"}}};

// NaN is outside every range.
Status check_range(std::string_view what, double value, double low, double high) {
    if (is_within(value, low, high)) return {};
    return fail(ErrorCode::bad_argument, "{} must be {} to {}, not {}", what, low, high, value);
}

}  // namespace

Result<Product> product_from_name(std::string_view name) {
    for (const Named& candidate : products) {
        if (candidate.name == name) return candidate.product;
    }
    std::string known;
    for (const Named& candidate : products) {
        if (!known.empty()) known += ", ";
        known += candidate.name;
    }
    return fail(ErrorCode::bad_argument, "unknown product '{}': known are {}", name, known);
}

std::string_view product_name(Product product) {
    for (const Named& candidate : products) {
        if (candidate.product == product) return candidate.name;
    }
    return "unknown";
}

Status validate(const Scene& scene) {
    const Camera& camera = scene.camera;
    if (!std::isfinite(camera.azimuth_deg)) {
        return fail(ErrorCode::bad_argument, "azimuth must be a finite number of degrees, not {}",
                    camera.azimuth_deg);
    }
    if (camera.eye && camera.field_of_view_deg == 0) {
        return fail(ErrorCode::bad_argument,
                    "a camera with a place of its own needs a field of view above 0 degrees");
    }
    const Eye eye = camera.eye.value_or(Eye{});
    const std::array<Status, 12> checks = {
        check_range("width", scene.width, 16, 8192),
        check_range("height", scene.height, 16, 8192),
        check_range("tilt", camera.tilt_deg, 0, camera.eye ? 180 : 90),
        camera.field_of_view_deg == 0
            ? Status{}
            : check_range("field of view", camera.field_of_view_deg, 1, 150),
        check_range("the camera's place to the east (m)", eye.x_m, -1e7, 1e7),
        check_range("the camera's place to the north (m)", eye.y_m, -1e7, 1e7),
        check_range("the camera's height (m)", eye.height_m, -1e3, 1e7),
        check_range("zoom", camera.zoom, 0.01, 1000),
        check_range("slices", scene.slices, 8, 4096),
        check_range("exaggeration", scene.vertical_exaggeration, 0.1, 100),
        check_range("opacity", scene.opacity, 1e-3, 1e3),
        check_range("range ring spacing (m)", scene.range_ring_spacing_m, 1e3, 1e6),
    };
    for (const Status& check : checks) {
        if (!check) return check;
    }
    return {};
}

}  // namespace stormcellar::render
