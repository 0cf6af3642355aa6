#include "stormcellar/render/scene.h"

#include <array>
#include <cmath>

#include "base/floating_point.h"
#include "render/color/built_in_tables.h"

namespace stormcellar::render {
namespace {

// Checks a range; NaN is outside every range.
Status check_range(std::string_view what, double value, NumberRange range) {
    if (is_within(value, range.least, range.most)) return {};
    return fail(ErrorCode::bad_argument, "{} must be {} to {}, not {}", what, range.least,
                range.most, value);
}

bool is_place(grid::GeoPoint point) {
    const auto is_in = [](double value, NumberRange range) {
        return is_within(value, range.least, range.most);
    };
    return is_in(point.latitude_deg, limits::latitude_deg) &&
           is_in(point.longitude_deg, limits::longitude_deg);
}

Status check_section(const Scene& scene) {
    if (!scene.section) {
        if (scene.product != Product::section) return {};
        return fail(ErrorCode::bad_argument, "a section needs two places between which it runs");
    }
    const SectionLine& line = *scene.section;
    if (!is_place(line.from) || !is_place(line.to)) {
        return fail(ErrorCode::bad_argument,
                    "a section's ends must be latitudes of {} to {} and longitudes of {} to {} "
                    "degrees, not {},{} and {},{}",
                    limits::latitude_deg.least, limits::latitude_deg.most,
                    limits::longitude_deg.least, limits::longitude_deg.most, line.from.latitude_deg,
                    line.from.longitude_deg, line.to.latitude_deg, line.to.longitude_deg);
    }
    const grid::SiteFrame start(line.from.latitude_deg, line.from.longitude_deg);
    return check_range("the length of a section (km)", start.to_polar(line.to).arc_m / 1000,
                       limits::section_km);
}

Status check_classes(const Scene& scene) {
    const bool has_classes = level2::facts_of(scene.moment).is_categorical;
    if (!has_classes || facts_of(scene.product).is_of_sweep) return {};
    return fail(ErrorCode::bad_argument,
                "{} has classes, which have no mean, so it is drawn as a ppi and not as {}",
                level2::moment_name(scene.moment), product_name(scene.product));
}

Status check_colors(const Scene& scene) {
    if (const Status fits = check_classes(scene); !fits) return fits;
    const auto only = facts_of(scene.product).only_moment;
    if (only && scene.moment != *only) {
        return fail(
            ErrorCode::bad_argument, "{} is made from {}, not from {}", product_name(scene.product),
            *only == level2::Moment::ref ? "reflectivity (REF)" : level2::moment_name(*only),
            level2::moment_name(scene.moment));
    }
    if (!scene.colors) return {};
    if (auto valid = validate(*scene.colors); !valid) {
        return fail(ErrorCode::bad_argument, "color table {}: it {}", scene.colors->name,
                    valid.error().message);
    }
    const std::string wanted = unit_shown(scene);
    const std::string& unit = scene.colors->unit;
    // A table that states no unit fits any picture. A table for RHO states that its values have no
    // unit.
    const bool of_numbers = unit_of(scene.colors->moment).empty();
    if (unit == wanted || (unit.empty() && !of_numbers)) return {};
    return fail(ErrorCode::bad_argument, "color table {} is {}, but the picture is {}",
                scene.colors->name, unit.empty() ? "without a unit" : "in " + unit,
                wanted.empty() ? "without a unit" : "in " + wanted);
}

Status check_glyphs(const Scene& scene) {
    if (!scene.glyphs || has_beam_glyphs(scene.moment)) return {};
    return fail(ErrorCode::bad_argument, "beam glyphs show velocities, not {}",
                level2::moment_name(scene.moment));
}

Status check_look_at(const Camera& camera) {
    if (!camera.eye || !camera.look_at) return {};
    const double apart_m =
        std::hypot(camera.eye->x_m - camera.look_at->x_m, camera.eye->y_m - camera.look_at->y_m,
                   camera.eye->height_m - camera.look_at->height_m);
    if (apart_m > 0) return {};
    return fail(ErrorCode::bad_argument, "the camera is at the very point that it looks at");
}

}  // namespace

bool has_beam_glyphs(level2::Moment moment) {
    const level2::MomentFacts& facts = level2::facts_of(moment);
    return facts.is_signed && facts.units == "m/s";
}

Status validate(const Scene& scene) {
    const Camera& camera = scene.camera;
    if (!std::isfinite(camera.azimuth_deg)) {
        return fail(ErrorCode::bad_argument, "azimuth must be a finite number of degrees, not {}",
                    camera.azimuth_deg);
    }
    if (!std::isfinite(scene.light.sun_azimuth_deg)) {
        return fail(ErrorCode::bad_argument, "the sun's azimuth must be finite, not {}",
                    scene.light.sun_azimuth_deg);
    }
    if (camera.eye && camera.field_of_view_deg == 0) {
        return fail(ErrorCode::bad_argument,
                    "a camera with a position of its own needs a field of view above 0 degrees");
    }
    const Eye eye = camera.eye.value_or(Eye{});
    const Eye look_at = camera.look_at.value_or(Eye{});
    const std::array<Status, 26> checks = {
        check_range("width", scene.width, limits::side_px),
        check_range("height", scene.height, limits::side_px),
        check_range("tilt", camera.tilt_deg,
                    camera.eye ? limits::tilt_of_eye_deg : limits::tilt_deg),
        camera.field_of_view_deg == 0
            ? Status{}
            : check_range("field of view", camera.field_of_view_deg, limits::field_of_view_deg),
        check_range("the camera's place to the east (m)", eye.x_m, limits::eye_m),
        check_range("the camera's place to the north (m)", eye.y_m, limits::eye_m),
        check_range("the camera's height (m)", eye.height_m, limits::eye_height_m),
        check_range("the point to look at, to the east (m)", look_at.x_m, limits::eye_m),
        check_range("the point to look at, to the north (m)", look_at.y_m, limits::eye_m),
        check_range("the height to look at (m)", look_at.height_m, limits::eye_height_m),
        check_look_at(camera),
        check_range("zoom", camera.zoom, limits::zoom),
        check_range("slices", scene.slices, limits::slices),
        check_range("exaggeration", scene.vertical_exaggeration, limits::exaggeration),
        check_range("pixel tolerance", scene.pixel_tolerance, limits::pixel_tolerance),
        check_range("the sun's elevation", scene.light.sun_elevation_deg,
                    limits::sun_elevation_deg),
        check_range("opacity", scene.opacity, limits::opacity),
        scene.range_ring_spacing_m == Scene::usual_rings
            ? Status{}
            : check_range("range ring spacing (m)", scene.range_ring_spacing_m,
                          limits::ring_spacing_m),
        check_range("the height of a CAPPI (m)", scene.cappi_height_m, limits::cappi_height_m),
        check_range("the threshold of echo tops (dBZ)", scene.echo_top_dbz, limits::echo_top_dbz),
        scene.elevation_deg == Scene::lowest_sweep
            ? Status{}
            : check_range("elevation", scene.elevation_deg, limits::elevation_deg),
        scene.sweep_number == Scene::no_number
            ? Status{}
            : check_range("the number of a sweep", scene.sweep_number, limits::sweep_number),
        retrieve::validate(scene.freezing_levels),
        check_section(scene),
        check_glyphs(scene),
        check_colors(scene),
    };
    for (const Status& check : checks) {
        if (!check) return check;
    }
    return {};
}

}  // namespace stormcellar::render
