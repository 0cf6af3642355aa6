#include "grid/sweep/sweep_stack.h"

#include <algorithm>

#include "stormcellar/base/station_table.h"

namespace stormcellar::grid {
namespace {

constexpr double farthest_arc_m = 1e6;  // no radar sees farther; bounds the size of tables

// Returns true if every radial was measured higher than all radials of lower sweeps.
bool are_in_order(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen) {
    float highest_deg = -90;  // highest elevation so far
    for (const ChosenSweep& sweep : chosen) {
        const float floor_deg = highest_deg;
        for (const std::uint32_t radial : sweep.radials) {
            const float elevation_deg =
                volume.sweeps[sweep.sweep_index].radials[radial].elevation_deg;
            if (elevation_deg <= floor_deg) return false;
            highest_deg = std::max(highest_deg, elevation_deg);
        }
    }
    return true;
}

// Returns true if the beams are in the order of their elevations, and about as far apart as their
// elevations imply. Ducts make beams cross, or make them wider or narrower.
bool are_beams_in_order(const SweepStack& stack) {
    constexpr float even = 1.5F;
    for (std::size_t i = 1; i + 1 < stack.table_size; ++i) {
        float below_m = 0, below_deg = 0, below_rise = 0;
        bool has_below = false;
        for (std::size_t at = 0; at < stack.sweeps.size(); ++at) {
            const BeamHeights heights = stack.sweeps[at].beam().heights({i, 0});
            if (!(heights.center_m < highest_beam_m)) continue;
            const float rise = stack.sweeps[at].beam().rise_m_per_deg(heights);
            const float apart_m = heights.center_m - below_m;
            const float apart_deg = stack.elevations_deg[at] - below_deg;
            const float least_m = std::max(rise, below_rise) * apart_deg / even;
            const float most_m = std::min(rise, below_rise) * apart_deg * even;
            if (has_below && !(apart_m > 0 && least_m <= apart_m && apart_m <= most_m))
                return false;
            below_m = heights.center_m;
            below_deg = stack.elevations_deg[at];
            below_rise = rise;
            has_below = true;
        }
    }
    return true;
}

}  // namespace

bool is_tdwr(std::string_view icao) {
    const auto station = find_station(icao);
    return station && station->kind == RadarKind::tdwr;
}

BeamModel beam_model_of(const SitePosition& site, ChosenBeam kind,
                        const std::optional<RefractivityProfile>& profile) {
    switch (kind) {
        case BeamKind::flat_earth:
            return BeamModel::flat_earth(site.altitude_m);
        case BeamKind::traced:
            return BeamModel::traced(site.latitude_deg, site.altitude_m,
                                     profile ? *profile : RefractivityProfile::reference());
        case BeamKind::four_thirds:
            break;
    }
    return BeamModel::four_thirds(site.latitude_deg, site.altitude_m);
}

SweepStack make_stack(const level2::Volume& volume, const SitePosition& site,
                      const std::vector<ChosenSweep>& chosen, const StackOptions& options) {
    const BeamModel beam = beam_model_of(site, options.method.beam, options.profile);
    double farthest_m = 0;
    for (const ChosenSweep& sweep : chosen) {
        farthest_m = std::max(farthest_m, greatest_arc_m(volume.sweeps[sweep.sweep_index], sweep,
                                                         options.moment, beam));
    }
    SweepStack stack;
    stack.beam_width_deg = static_cast<float>(options.beam_width_deg);
    stack.table_size =
        3 + static_cast<std::size_t>(std::min(farthest_m, farthest_arc_m) / ArcTable::step_m);
    const PolarSweepOptions sweep_options{
        options.moment,           options.beam_width_deg / 2, is_tdwr(site.icao), stack.table_size,
        options.method.averaging, options.method.on_circle,   options.method.cell};
    for (const ChosenSweep& sweep : chosen) {
        const level2::Sweep& source = volume.sweeps[sweep.sweep_index];
        stack.sweeps.emplace_back(source, sweep, beam, sweep_options);
        stack.adjacent_to_next.push_back(sweep.adjacent_to_next);
        stack.elevations_deg.push_back(static_cast<float>(sweep.elevation_deg));
        for (const level2::SweepMoment& kind : source.moments) {
            if (kind.moment != options.moment) continue;
            stack.gate_spacing_m =
                std::max(stack.gate_spacing_m, static_cast<float>(kind.gate_spacing_m));
        }
    }
    stack.in_order = are_in_order(volume, chosen) &&
                     (beam.kind() != BeamKind::traced || are_beams_in_order(stack));
    return stack;
}

}  // namespace stormcellar::grid
