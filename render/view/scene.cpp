#include "stormcellar/render/scene.h"

#include <array>
#include <cmath>

#include "base/floating_point.h"
#include "render/colour/built_in_tables.h"

namespace stormcellar::render {
namespace {

struct Named {
    Product product;
    std::string_view name;
};
constexpr std::array<Named, 8> products = {{{Product::volume, "volume"},
                                            {Product::composite, "composite"},
                                            {Product::cappi, "cappi"},
                                            {Product::section, "section"},
                                            {Product::echo_top, "echotop"},
                                            {Product::vil, "vil"},
                                            {Product::lowest_seen, "lowest-seen"},
                                            {Product::highest_seen, "highest-seen"}}};

// Checks a range; NaN is outside every range.
Status check_range(std::string_view what, double value, double low, double high) {
    if (is_within(value, low, high)) return {};
    return fail(ErrorCode::bad_argument, "{} must be {} to {}, not {}", what, low, high, value);
}

bool is_place(grid::GeoPoint point) {
    return is_within(point.latitude_deg, -90.0, 90.0) &&
           is_within(point.longitude_deg, -180.0, 360.0);
}

Status check_section(const Scene& scene) {
    if (!scene.section) {
        if (scene.product != Product::section) return {};
        return fail(ErrorCode::bad_argument, "a section needs two places to go between");
    }
    const SectionLine& line = *scene.section;
    if (!is_place(line.from) || !is_place(line.to)) {
        return fail(ErrorCode::bad_argument,
                    "a section's ends must be latitudes of -90 to 90 and longitudes of -180 to 360 "
                    "degrees, not {},{} and {},{}",
                    line.from.latitude_deg, line.from.longitude_deg, line.to.latitude_deg,
                    line.to.longitude_deg);
    }
    const grid::SiteFrame start(line.from.latitude_deg, line.from.longitude_deg);
    return check_range("the length of a section (km)", start.to_polar(line.to).arc_m / 1000, 1,
                       5000);
}

Status check_colours(const Scene& scene) {
    const bool needs_ref = scene.product == Product::echo_top || scene.product == Product::vil;
    if (needs_ref && scene.moment != level2::Moment::ref) {
        return fail(ErrorCode::bad_argument, "{} is made of reflectivity (REF), not of {}",
                    product_name(scene.product), level2::moment_name(scene.moment));
    }
    if (!scene.colours) return {};
    if (auto valid = validate(*scene.colours); !valid) {
        return fail(ErrorCode::bad_argument, "colour table {}: it {}", scene.colours->name,
                    valid.error().message);
    }
    const std::string wanted = unit_shown(scene);
    const std::string& unit = scene.colours->unit;
    // A table of RHO has no unit either.
    const bool of_numbers = scene.colours->moment == level2::Moment::rho;
    if (unit == wanted || (unit.empty() && !of_numbers)) return {};
    return fail(ErrorCode::bad_argument, "colour table {} is {}, the picture {}",
                scene.colours->name, unit.empty() ? "without a unit" : "in " + unit,
                wanted.empty() ? "without a unit" : "in " + wanted);
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

bool is_map(Product product) {
    return product != Product::volume && product != Product::section;
}

const ColourTable& colours_of(const Scene& scene) {
    if (scene.colours) return *scene.colours;
    switch (scene.product) {
        case Product::echo_top:
            return echo_top_colours();
        case Product::vil:
            return vil_colours();
        case Product::lowest_seen:
        case Product::highest_seen:
            return height_colours();
        default:
            return default_colour_table(scene.moment);
    }
}

std::string unit_shown(const Scene& scene) {
    switch (scene.product) {
        case Product::echo_top:
        case Product::lowest_seen:
        case Product::highest_seen:
            return "km";
        case Product::vil:
            return "kg/m2";
        default:
            return unit_of(scene.moment);
    }
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
                    "a camera with a place of its own needs a field of view above 0 degrees");
    }
    const Eye eye = camera.eye.value_or(Eye{});
    const std::array<Status, 18> checks = {
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
        check_range("pixel tolerance", scene.pixel_tolerance, 0, 0.1),
        check_range("the sun's elevation", scene.light.sun_elevation_deg, 5, 90),
        check_range("opacity", scene.opacity, 1e-3, 1e3),
        check_range("range ring spacing (m)", scene.range_ring_spacing_m, 1e3, 1e6),
        check_range("the height of a CAPPI (m)", scene.cappi_height_m, -1e3, 6e4),
        check_range("the threshold of echo tops (dBZ)", scene.echo_top_dbz, -30, 80),
        check_section(scene),
        check_colours(scene),
    };
    for (const Status& check : checks) {
        if (!check) return check;
    }
    return {};
}

}  // namespace stormcellar::render
