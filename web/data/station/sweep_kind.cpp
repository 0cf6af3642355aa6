#include "web/data/station/sweep_kind.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace stormcellar::web {
namespace {

constexpr double angle_tolerance_deg = 0.15;
constexpr double fine_below_deg = 0.75;  // spacings below this are 0.5 degrees, others 1 degree

// Returns 0.5 or 1, by the median distance of neighboring azimuths.
double azimuth_spacing_of(const level2::Sweep& sweep) {
    std::vector<float> azimuths;
    for (const level2::Radial& radial : sweep.radials)
        azimuths.push_back(radial.azimuth_deg);
    std::ranges::sort(azimuths);
    std::vector<float> steps;
    for (std::size_t i = 1; i < azimuths.size(); ++i)
        steps.push_back(azimuths[i] - azimuths[i - 1]);
    if (steps.empty()) return 1;
    std::ranges::sort(steps);
    const std::size_t middle = steps.size() / 2;
    const float median =
        steps.size() % 2 == 1 ? steps[middle] : (steps[middle - 1] + steps[middle]) / 2;
    return median < fine_below_deg ? 0.5 : 1;
}

}  // namespace

bool SweepKind::is_like(const SweepKind& other) const {
    return has_velocity == other.has_velocity && azimuth_spacing_deg == other.azimuth_spacing_deg &&
           first_gate_m == other.first_gate_m && gate_spacing_m == other.gate_spacing_m &&
           std::abs(angle_deg - other.angle_deg) <= angle_tolerance_deg;
}

double fixed_angle_of(const level2::Sweep& sweep) {
    return sweep.vcp_elevation_deg ? double{*sweep.vcp_elevation_deg} : sweep.mean_elevation_deg();
}

std::vector<const level2::SweepMoment*> first_arrays(const level2::Sweep& sweep) {
    std::vector<const level2::SweepMoment*> arrays;
    for (const level2::SweepMoment& array : sweep.moments)
        if (sweep.find(array.moment) == &array) arrays.push_back(&array);
    return arrays;
}

const level2::SweepMoment& finest_array(const level2::Sweep& sweep) {
    const auto arrays = first_arrays(sweep);
    return **std::ranges::min_element(arrays, {}, &level2::SweepMoment::gate_spacing_m);
}

SweepKind kind_of_sweep(const level2::Sweep& sweep) {
    const level2::SweepMoment& finest = finest_array(sweep);
    return {.angle_deg = fixed_angle_of(sweep),
            .has_velocity = sweep.find(level2::Moment::vel) != nullptr,
            .azimuth_spacing_deg = azimuth_spacing_of(sweep),
            .first_gate_m = finest.first_gate_m,
            .gate_spacing_m = finest.gate_spacing_m};
}

std::vector<const level2::Sweep*> cuts_of(const level2::Volume& volume) {
    std::map<int, const level2::Sweep*> best;
    for (const level2::Sweep& sweep : volume.sweeps) {
        if (sweep.radials.empty() || sweep.moments.empty()) continue;
        const level2::Sweep*& known = best.emplace(sweep.elevation_number, &sweep).first->second;
        if (sweep.radials.size() >= known->radials.size()) known = &sweep;
    }
    std::vector<const level2::Sweep*> cuts;
    for (const auto& [number, sweep] : best)
        cuts.push_back(sweep);
    std::ranges::sort(cuts);  // they are elements of one vector, so this is the order of the file
    return cuts;
}

}  // namespace stormcellar::web
