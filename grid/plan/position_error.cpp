#include "grid/plan/position_error.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/degree.h"
#include "grid/sweep/sweep_stack.h"
#include "stormcellar/accuracy/quantity.h"

namespace stormcellar::grid {
namespace {

constexpr double table_bound_m = 1e-3;

double jitter_m(const PositionScene& scene, double reach) {
    const double top_m = scene.spec.levels_m.back() - scene.site.altitude_m;
    double most_m = 0;
    for (const ChosenSweep& sweep : scene.chosen) {
        const double elevation = sweep.elevation_deg * degree;
        const double below_top_m =
            elevation > 0.01 ? std::max(0.0, top_m) / std::sin(elevation) : HUGE_VAL;
        const double range_m = std::min(reach / std::cos(elevation), below_top_m);
        for (const std::uint32_t radial : sweep.radials) {
            const double off_deg =
                static_cast<double>(
                    scene.volume.sweeps[sweep.sweep_index].radials[radial].elevation_deg) -
                sweep.elevation_deg;
            most_m = std::max(most_m, std::abs(off_deg) * degree * range_m);
        }
    }
    return most_m;
}

double beam_difference_m(const PositionScene& scene, BeamKind a, BeamKind b) {
    std::vector<double> elevations_deg;
    for (const ChosenSweep& sweep : scene.chosen)
        elevations_deg.push_back(sweep.elevation_deg);
    BeamLimits limits;
    limits.arc_m = limits.range_m = reach_m(scene);
    limits.floor_m = std::min(0.0, scene.spec.levels_m.front());
    limits.ceiling_m = scene.spec.levels_m.back();
    return greatest_difference(beam_model_of(scene.site, a, scene.profile),
                               beam_model_of(scene.site, b, scene.profile), elevations_deg, limits)
        .gate_m;
}

}  // namespace

double reach_m(const PositionScene& scene) {
    double farthest_m = 0;
    const BeamModel beam = BeamModel::four_thirds(scene.site.latitude_deg, scene.site.altitude_m);
    for (const ChosenSweep& sweep : scene.chosen) {
        farthest_m = std::max(farthest_m, greatest_arc_m(scene.volume.sweeps[sweep.sweep_index],
                                                         sweep, scene.moment, beam));
    }
    return std::min(farthest_m, reach_m(scene.site, scene.spec));
}

double effect_position_m(const PositionScene& scene, std::string_view effect) {
    const bool centered = is_centered_at(scene.site, scene.spec);
    if (effect == "ellipsoid") {
        return centered ? 0
                        : frame_error_bound_m(FrameKind::sphere, scene.site.latitude_deg,
                                              reach_m(scene));
    }
    if (effect == "exact_geodesic") return centered ? 0 : table_bound_m;
    if (effect == "earth_curvature") {
        return beam_difference_m(scene, BeamKind::flat_earth, BeamKind::four_thirds);
    }
    if (effect == "refraction") {
        return beam_difference_m(scene, BeamKind::four_thirds, BeamKind::traced);
    }
    return effect == "antenna_jitter" ? jitter_m(scene, reach_m(scene)) : 0;
}

double position_error_bound_m(const PositionScene& scene, FrameKind frame, const Method& method) {
    double sum_m = 0;
    if (frame == FrameKind::sphere) sum_m += effect_position_m(scene, "ellipsoid");
    if (frame != FrameKind::geodesic) sum_m += effect_position_m(scene, "exact_geodesic");
    if (method.beam == BeamKind::flat_earth) sum_m += effect_position_m(scene, "earth_curvature");
    if (method.beam != BeamKind::traced) sum_m += effect_position_m(scene, "refraction");
    if (!method.radial_elevations) sum_m += effect_position_m(scene, "antenna_jitter");
    return sum_m;
}

std::string unplanned_error(const level2::Volume& volume, const SitePosition& site,
                            const GridSpec& spec, FrameKind frame, const GridderOptions& options) {
    const auto chosen = sweeps_to_grid(volume, site, options);
    const RefractivityProfile profile = options.profile.value_or(RefractivityProfile::reference());
    const double bound_m = position_error_bound_m(
        {volume, site, spec, chosen, profile, options.moment}, frame, options.method);
    return fmt::format(
        "position {}, values not predicted, against the chain's exact form",
        accuracy::format_quantity(accuracy::Quantity::position, bound_m, accuracy::ValueUnit::db));
}

}  // namespace stormcellar::grid
