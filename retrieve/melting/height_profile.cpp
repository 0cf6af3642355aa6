#include "retrieve/melting/height_profile.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/degree.h"
#include "retrieve/quality/gate_field.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/retrieve/melting_layer.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr float least_dbz = 15, most_dbz = 47, least_correlation = 0.7F;
constexpr double nearest_m = 5000;
constexpr std::size_t least_gates = 8;
// One-way half-power width of 0.95 degrees, times 1 / sqrt(16 ln 2) for the two-way pattern.
constexpr double beam_sigma_rad = 0.95 * degree * 0.3003;

GateField field_of(const level2::Sweep& sweep, Moment moment) {
    const level2::SweepMoment* found = sweep.find(moment);
    return found != nullptr ? gate_field(sweep, *found) : GateField{};
}

// The gate of a reflectivity field with its level and its places in the other fields.
struct GatePlace {
    std::size_t gate = 0, level = 0, zdr = 0, rho = 0;
    double range_m = 0;
};

std::vector<GatePlace> gate_places(const GateField& reflectivity, const GateField& zdr,
                                   const GateField& rho, double elevation_deg) {
    // The latitude hardly matters: it changes heights by less than 0.2 %.
    const grid::BeamGeometry beam(40, 0);
    std::vector<GatePlace> places;
    for (std::size_t gate = 0; gate < reflectivity.gates; ++gate) {
        const double range = reflectivity.range_m(gate);
        const double level = beam.forward({range, elevation_deg}).height_m / profile_step_m;
        const std::int32_t zdr_gate = zdr.gate_at(range), rho_gate = rho.gate_at(range);
        const bool is_inside = range >= nearest_m && level >= 0 && level < profile_levels;
        if (is_inside && zdr_gate >= 0 && rho_gate >= 0)
            places.push_back({gate, static_cast<std::size_t>(level),
                              static_cast<std::size_t>(zdr_gate),
                              static_cast<std::size_t>(rho_gate), range});
    }
    return places;
}

// Returns the mean of the middle half of the values.
double middle_mean(std::vector<float> values) {
    const auto quarter = static_cast<std::ptrdiff_t>(values.size() / 4);
    const auto first = values.begin() + quarter, last = values.end() - quarter;
    std::nth_element(values.begin(), first, values.end());
    std::nth_element(first, last - 1, values.end());
    return std::accumulate(first, last, 0.0) / static_cast<double>(last - first);
}

}  // namespace

std::vector<SectorSums> sums_by_sector(const level2::Sweep& sweep) {
    const GateField reflectivity = field_of(sweep, Moment::ref), zdr = field_of(sweep, Moment::zdr),
                    rho = field_of(sweep, Moment::rho);
    if (reflectivity.is_empty() || zdr.is_empty() || rho.is_empty()) return {};
    const auto places = gate_places(reflectivity, zdr, rho, sweep.mean_elevation_deg());
    std::vector<SectorSums> sums(MeltingLayer::sector_count);
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        const auto azimuth = static_cast<double>(sweep.radials[radial].azimuth_deg);
        if (!std::isfinite(azimuth)) continue;
        SectorSums& sector = sums[MeltingLayer::sector_of(azimuth)];
        for (const GatePlace& place : places) {
            const float dbz = reflectivity.value(radial, place.gate);
            const float correlation = rho.value(radial, place.rho);
            const float differential = zdr.value(radial, place.zdr);
            const bool counts = dbz >= least_dbz && dbz <= most_dbz &&
                                correlation >= least_correlation && !std::isnan(differential);
            if (!counts) continue;
            LevelSums& level = sector[place.level];
            level.correlations.push_back(correlation);
            level.reflectivity_sum += static_cast<double>(dbz);
            level.zdr_sum += static_cast<double>(differential);
            level.range_sum_m += place.range_m;
        }
    }
    return sums;
}

SectorSums sums_of_circle(std::span<const SectorSums> sectors) {
    SectorSums all;
    for (const SectorSums& sector : sectors)
        for (std::size_t level = 0; level < profile_levels; ++level) {
            LevelSums& to = all[level];
            const LevelSums& from = sector[level];
            to.correlations.insert(to.correlations.end(), from.correlations.begin(),
                                   from.correlations.end());
            to.reflectivity_sum += from.reflectivity_sum;
            to.zdr_sum += from.zdr_sum;
            to.range_sum_m += from.range_sum_m;
        }
    return all;
}

HeightProfile height_profile(const SectorSums& sums) {
    HeightProfile profile;
    for (std::size_t level = 0; level < profile_levels; ++level) {
        const LevelSums& from = sums[level];
        if (from.correlations.size() < least_gates) continue;
        const auto gates = static_cast<double>(from.correlations.size());
        profile[level] = {middle_mean(from.correlations), from.reflectivity_sum / gates,
                          from.zdr_sum / gates, from.range_sum_m / gates * beam_sigma_rad};
    }
    return profile;
}

}  // namespace stormcellar::retrieve
