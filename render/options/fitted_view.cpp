#include "render/options/fitted_view.h"

#include <algorithm>
#include <cmath>

#include "render/color/built_in_tables.h"

namespace stormcellar::render {
namespace {

bool is_typed(const SceneOptions& options, ViewPart part) {
    return contains(options.typed, option_of(part));
}

bool file_has_a_view(const SceneOptions& options) {
    return std::ranges::any_of(options.in_file, [](const PictureOption* row) {
        return row->section == "camera" || row->section == "light" || row->section == "volume";
    });
}

// Returns true if two views show nearly the same part of the grid from nearly the same place.
bool is_near(const FittedView& one, const FittedView& other) {
    if (one.has_echo != other.has_echo) return false;
    if (!one.has_echo) return true;
    const double moved_m =
        std::hypot(one.focus.x_m - other.focus.x_m, one.focus.y_m - other.focus.y_m);
    const double nearest_m = std::min(one.distance_m, other.distance_m);
    const double farthest_m = std::max(one.distance_m, other.distance_m);
    const double turned_deg = std::abs(one.camera.azimuth_deg - other.camera.azimuth_deg);
    return moved_m <= 0.1 * nearest_m && farthest_m <= 1.25 * nearest_m && turned_deg <= 25;
}

}  // namespace

FitParts parts_to_fit(const SceneOptions& options) {
    if (file_has_a_view(options)) return FitParts::none();
    FitParts parts;
    const auto is_open = [&](ViewPart part) { return !is_typed(options, part); };
    const Camera& camera = options.scene.camera;
    const bool has_place = camera.eye.has_value();
    const bool is_parallel =
        is_typed(options, ViewPart::field_of_view) && camera.field_of_view_deg == 0;
    parts.azimuth = is_open(ViewPart::azimuth) && !has_place;
    parts.tilt = is_open(ViewPart::tilt) && !has_place;
    parts.field_of_view = is_open(ViewPart::field_of_view) && !has_place;
    parts.place = is_open(ViewPart::zoom) && !has_place && !camera.look_at && !is_parallel;
    parts.exaggeration = is_open(ViewPart::exaggeration) && !has_place;
    parts.opacity = is_open(ViewPart::opacity);
    parts.sun = is_open(ViewPart::sun);
    return parts;
}

bool fits_anything(const SceneOptions& options) {
    return parts_to_fit(options).any() || options.colors.empty();
}

bool chooses_light(const SceneOptions& options) {
    return !is_typed(options, ViewPart::light) && !file_has_a_view(options);
}

Result<FittedView> fit_picture(const EchoOutline& outline, const grid::BrickView& view,
                               const FrameFacts& facts, const SceneOptions& options, Scene& scene,
                               bool orbits, std::optional<FittedView>* last) {
    // By default, echo that is too weak for the usual colors gets the colors for clear air.
    if (scene.colors == smooth_color_table(level2::Moment::ref) && options.colors.empty() &&
        is_clear_air(outline)) {
        scene.colors = clear_air_colors();
    }
    if (view_of(scene.product) != View::volume) return FittedView{};
    if (chooses_light(options)) scene.light.gradient = scene.light.shadow = true;
    const auto fitted = fit_scene(outline, view, facts, parts_to_fit(options), scene, orbits);
    if (!fitted || last == nullptr) return fitted;
    if (*last && is_near(**last, *fitted)) {
        apply(**last, scene);
    } else {
        *last = *fitted;
    }
    return **last;
}

}  // namespace stormcellar::render
