#include "cli/picture/scene_options.h"

#include <algorithm>
#include <thread>

#include <CLI/CLI.hpp>

#include "base/local_time.h"
#include "base/number_list.h"
#include "cli/picture/product_options.h"
#include "render/colour/colour_file.h"

namespace stormcellar::cli {

namespace {

constexpr const char* group = "Picture";

void add_product_options(CLI::App& app, SceneOptions& options) {
    render::Scene& scene = options.scene;
    app.add_option("--product", options.product,
                   "volume, composite (column maximum), cappi, section, echotop, vil, lowest-seen "
                   "or highest-seen")
        ->group(group)
        ->capture_default_str();
    app.add_option("--moment", options.moment, "REF, VEL, SW, ZDR, PHI, RHO or CFP")
        ->group(group)
        ->capture_default_str();
    app.add_option("--colours", options.colours,
                   "A colour table by name, or a .pal or .toml file (default: the moment's)")
        ->group(group);
    app.add_option("--height-km", options.height_km, "Of a CAPPI, above sea level")
        ->group(group)
        ->capture_default_str();
    app.add_option("--section", options.section,
                   "LAT,LON,LAT,LON: the two ends of a vertical section")
        ->group(group);
    app.add_option("--echo-top-dbz", scene.echo_top_dbz, "The threshold of echo tops")
        ->group(group)
        ->capture_default_str();
}

// Adds camera, light, and how a volume is drawn.
void add_view_options(CLI::App& app, SceneOptions& options) {
    render::Scene& scene = options.scene;
    app.add_option("--azimuth", scene.camera.azimuth_deg,
                   "Where the view is from, degrees: 180 is from the south, north up")
        ->group(group)
        ->capture_default_str();
    app.add_option("--tilt", scene.camera.tilt_deg,
                   "Degrees from the vertical: 0 straight down, 90 along the ground, with "
                   "--camera-km up to 180")
        ->group(group)
        ->capture_default_str();
    app.add_option("--zoom", scene.camera.zoom, "1 shows the whole grid")
        ->group(group)
        ->capture_default_str();
    app.add_option("--field-of-view", scene.camera.field_of_view_deg,
                   "Degrees across the picture, for a perspective view; 0: parallel rays")
        ->group(group)
        ->capture_default_str();
    app.add_option("--camera-km", options.camera_at,
                   "EAST,NORTH,UP: where the camera stands, from the grid's middle and above sea "
                   "level (default: outside, looking at the middle)")
        ->group(group);
    app.add_option("--light", options.light,
                   "none (exact colours), or of gradient, shadow and scattering, with commas: "
                   "makes echo darker, never another hue")
        ->group(group)
        ->capture_default_str();
    app.add_option("--sun", options.sun,
                   "AZIMUTH,ELEVATION in degrees of the light (default: 225,40)")
        ->group(group);
    app.add_flag("--haze", scene.haze, "Of a volume: air that no beam saw is hazy, behind the echo")
        ->group(group);
    app.add_flag("--curved-earth", scene.curved_earth,
                 "The ground falls away from the grid's middle, as the earth does")
        ->group(group);
    app.add_option("--slices", scene.slices, "Slices through the volume, 8 to 4096")
        ->group(group)
        ->capture_default_str();
    app.add_option("--exaggeration", scene.vertical_exaggeration, "Stretches heights")
        ->group(group)
        ->capture_default_str();
    app.add_option("--opacity", scene.opacity, "Factor on how opaque echo is")
        ->group(group)
        ->capture_default_str();
}

void add_label_options(CLI::App& app, SceneOptions& options) {
    app.add_option("--ring-spacing-km", options.range_ring_spacing_km, "Between range rings")
        ->group(group)
        ->capture_default_str();
    app.add_option("--time-zone", options.time_zone,
                   "Of the local time, as America/Chicago (default: the machine's)")
        ->group(group);
    app.add_flag("--no-labels", options.no_labels, "The picture alone")->group(group);
    app.add_option("--threads", options.threads, "Else as many as the machine has")
        ->group(group)
        ->capture_default_str();
}

}  // namespace

void add_scene_options(CLI::App& app, SceneOptions& options) {
    render::Scene& scene = options.scene;
    add_product_options(app, options);
    app.add_option("--width", scene.width, "Pixels")->group(group)->capture_default_str();
    app.add_option("--height", scene.height, "Pixels")->group(group)->capture_default_str();
    add_view_options(app, options);
    add_label_options(app, options);
    note_typed_options(app, options);
}

Result<render::Scene> scene_of(const SceneOptions& options) {
    const auto product = render::product_from_name(options.product);
    if (!product) return pass_on(product);
    if (options.threads < 0 || options.threads > 1024) {
        return fail(ErrorCode::bad_argument, "threads must be 0 to 1024, not {}", options.threads);
    }
    if (auto used = check_product_options(*product, options); !used) return pass_on(used);
    render::Scene scene = options.scene;
    scene.product = *product;
    const auto moment = level2::moment_from_name(options.moment);
    if (!moment) {
        return fail(ErrorCode::bad_argument,
                    "unknown moment '{}': known are REF, VEL, SW, ZDR, PHI, RHO, CFP",
                    options.moment);
    }
    scene.moment = *moment;
    scene.cappi_height_m = options.height_km * 1e3;
    if (!options.section.empty()) {
        const auto ends = numbers_of("--section", options.section, 4);
        if (!ends) return pass_on(ends);
        scene.section = render::SectionLine{{(*ends)[0], (*ends)[1]}, {(*ends)[2], (*ends)[3]}};
    } else if (scene.product == render::Product::section) {
        return fail(ErrorCode::bad_argument,
                    "a section needs its two ends: --section LAT,LON,LAT,LON, or [picture] section "
                    "in a scene's file");
    }
    if (!options.colours.empty()) {
        auto colours = render::colours_from(options.colours);
        if (!colours) return pass_on(colours);
        scene.colours = std::move(*colours);
    }
    if (auto set = render::set_light(options.light, scene.light); !set) {
        return fail(set.error().code, "--light: {}", set.error().message);
    }
    if (!options.sun.empty()) {
        const auto sun = numbers_of("--sun", options.sun, 2);
        if (!sun) return pass_on(sun);
        scene.light.sun_azimuth_deg = (*sun)[0];
        scene.light.sun_elevation_deg = (*sun)[1];
    }
    if (!options.camera_at.empty()) {
        const auto at = numbers_of("--camera-km", options.camera_at, 3);
        if (!at) return pass_on(at);
        scene.camera.eye = render::Eye{(*at)[0] * 1e3, (*at)[1] * 1e3, (*at)[2] * 1e3};
        if (scene.camera.field_of_view_deg == 0) scene.camera.field_of_view_deg = 60;
    }
    if (!options.time_zone.empty() && !format_local(UtcTime{}, options.time_zone)) {
        return fail(ErrorCode::bad_argument, "--time-zone: '{}' is no time zone known here",
                    options.time_zone);
    }
    scene.range_ring_spacing_m = options.range_ring_spacing_km * 1e3;
    scene.labels = !options.no_labels;
    if (auto valid = render::validate(scene); !valid) return pass_on(valid);
    return scene;
}

Result<std::vector<double>> numbers_of(const std::string& option, const std::string& text,
                                       std::size_t count) {
    auto numbers = parse_numbers(text, ',');
    if (numbers && numbers->size() == count) return std::move(*numbers);
    return fail(ErrorCode::bad_argument, "{} needs {} numbers with commas between them, not '{}'",
                option, count, text);
}

int thread_count(const SceneOptions& options) {
    if (options.threads > 0) return options.threads;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

render::FrameFacts facts_of(const std::string& domain, const cache::GridDescription& description,
                            const std::string& time_zone, UtcTime now) {
    render::FrameFacts facts{domain, description.moment, description.time, description.sites,
                             description.provenance.partial};
    facts.radar_troubles = description.provenance.radar_troubles;
    const std::string zone = time_zone.empty() ? machine_time_zone() : time_zone;
    const auto local = zone.empty() ? std::string{} : format_local(facts.time, zone).value_or("");
    if (!local.ends_with(" UTC")) facts.local_time = local;
    const auto age = std::chrono::floor<std::chrono::seconds>(now - description.end_time);
    if (age >= std::chrono::seconds(0) && age < std::chrono::hours(1)) {
        facts.antenna_to_picture = age;
    }
    return facts;
}

}  // namespace stormcellar::cli
