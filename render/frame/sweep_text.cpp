#include "render/frame/sweep_text.h"

#include <algorithm>

#include <fmt/format.h>

#include "render/map/coverage.h"
#include "render/map/map_ground.h"

namespace stormcellar::render {
namespace {

// Share of azimuths that counts as all; often a few radials are missing.
constexpr double whole_circle = 0.985;
// Share of the sweep's range that must be cut off to be mentioned.
constexpr double least_cut = 0.01;

// Returns true if some part of the circle within the sweep's range is outside the picture or the
// plane.
bool is_cut(const grid::SweepLookup& sweep, const grid::GridSpec& spec,
            const ViewGeometry& geometry) {
    const GroundPoint site =
        GroundMap(spec).ground({sweep.site().latitude_deg, sweep.site().longitude_deg});
    const GroundPoint none{};
    const GroundPoint top_left = geometry.ground({0, 0}).value_or(none);
    const GroundPoint bottom_right =
        geometry
            .ground({static_cast<double>(geometry.width()), static_cast<double>(geometry.height())})
            .value_or(none);
    const double east = std::min(geometry.half_x_m(), bottom_right.x_m) - site.x_m;
    const double west = site.x_m - std::max(-geometry.half_x_m(), top_left.x_m);
    const double north = std::min(geometry.half_y_m(), top_left.y_m) - site.y_m;
    const double south = site.y_m - std::max(-geometry.half_y_m(), bottom_right.y_m);
    return std::min({east, west, north, south}) < (1 - least_cut) * sweep.facts().greatest_arc_m;
}

}  // namespace

std::string sweep_text(const grid::SweepLookup& sweep, const grid::GridSpec& spec,
                       const ViewGeometry& geometry) {
    const grid::SweepFacts& facts = sweep.facts();
    const double circle = static_cast<double>(facts.radial_count) * facts.azimuth_spacing_deg / 360;
    std::string text = fmt::format("Cut {}: {} radials", facts.cut, facts.radial_count);
    if (circle < whole_circle) text += fmt::format(", {} of the circle", percent_text(circle));
    text += fmt::format(", gates of {:g} km", facts.gate_spacing_m / 1000);
    const double reach_km = facts.last_gate_m / 1000;
    return text + (is_cut(sweep, spec, geometry)
                       ? fmt::format("  \u00B7  view cut: the sweep reaches {:.0f} km", reach_km)
                       : fmt::format(" up to {:.0f} km", reach_km));
}

}  // namespace stormcellar::render
