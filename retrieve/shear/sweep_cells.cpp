#include "retrieve/shear/sweep_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/sweep/azimuth_table.h"
#include "stormcellar/grid/sweep_choice.h"

namespace stormcellar::retrieve {
namespace {

constexpr double usual_latitude_deg = 40;

std::vector<ArcGate> arc_gates(const level2::SweepMoment& moment, const grid::BeamGeometry& beam,
                               double elevation_deg) {
    std::vector<ArcGate> gates(ShearLayer::arcs);
    for (std::size_t arc = 0; arc < ShearLayer::arcs; ++arc) {
        const auto point = beam.over(ShearLayer::center(0, arc).arc_m, elevation_deg);
        const double gate =
            std::round((point.range_m - moment.first_gate_m) / moment.gate_spacing_m);
        if (!(gate >= 0 && gate < moment.gate_stride)) continue;
        gates[arc] = {static_cast<std::int32_t>(gate),
                      static_cast<float>(point.height_m - beam.antenna_altitude_m())};
    }
    return gates;
}

}  // namespace

SweepCells::SweepCells(const level2::Sweep& sweep, const level2::SweepMoment& moment,
                       const grid::BeamGeometry& beam) {
    std::vector<std::pair<float, std::size_t>> by_azimuth;
    double elevations_deg = 0;
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        const auto azimuth_deg = grid::normal_azimuth(sweep.radials[radial].azimuth_deg);
        const float elevation_deg = sweep.radials[radial].elevation_deg;
        if (!azimuth_deg || !std::isfinite(elevation_deg) || moment.gate_counts[radial] == 0)
            continue;
        by_azimuth.emplace_back(*azimuth_deg, radial);
        elevations_deg += static_cast<double>(elevation_deg);
    }
    if (by_azimuth.empty() || moment.gate_spacing_m <= 0) return;
    std::ranges::sort(by_azimuth);
    std::vector<float> azimuths_deg;
    azimuths_deg.reserve(by_azimuth.size());
    for (const auto& entry : by_azimuth)
        azimuths_deg.push_back(entry.first);
    const grid::AzimuthTable table(
        azimuths_deg, grid::azimuth_spacing_deg(azimuths_deg, sweep.azimuth_spacing_deg));
    for (std::size_t azimuth = 0; azimuth < ShearLayer::azimuths; ++azimuth) {
        const int found =
            table.find(static_cast<float>(ShearLayer::center(azimuth, 0).azimuth_deg));
        radials_.push_back(found == grid::AzimuthTable::none
                               ? no_radial
                               : by_azimuth[static_cast<std::size_t>(found)].second);
    }
    gates_ = arc_gates(moment, beam, elevations_deg / static_cast<double>(by_azimuth.size()));
}

grid::BeamGeometry beam_of(const level2::Volume& volume) {
    const auto antenna = level2::antenna_position(volume);
    if (!antenna) return {usual_latitude_deg, 0};
    return {antenna->latitude_deg, antenna->altitude_m};
}

}  // namespace stormcellar::retrieve
