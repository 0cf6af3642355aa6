#include "tests/retrieve/velocity_sweep.h"

#include <cmath>

namespace stormcellar::retrieve {
namespace {

constexpr double zero_code = 32'768;

std::uint16_t code_of(double velocity_mps) {
    if (std::isnan(velocity_mps)) return 0;
    if (velocity_mps == range_folded) return 1;
    return static_cast<std::uint16_t>(std::lround(velocity_mps / finest_mps + zero_code));
}

}  // namespace

std::vector<float> even_azimuths(int radials) {
    std::vector<float> azimuths_deg;
    for (int radial = 0; radial < radials; ++radial)
        azimuths_deg.push_back(static_cast<float>((radial + 0.5) * 360 / radials));
    return azimuths_deg;
}

void add_sweep(level2::Volume& volume, const SweepSpec& spec, const SweepVelocity& velocity) {
    level2::Sweep sweep;
    sweep.elevation_number = static_cast<int>(volume.sweeps.size()) + 1;
    level2::SweepMoment moment;
    moment.moment = level2::Moment::vel;
    moment.first_gate_m = spec.first_gate_m;
    moment.gate_spacing_m = spec.gate_spacing_m;
    moment.gate_stride = spec.gates;
    moment.word_size_bits = 16;
    moment.scale = static_cast<float>(1 / finest_mps);
    moment.offset = static_cast<float>(zero_code);
    for (const float azimuth_deg : spec.azimuths_deg) {
        level2::Radial radial;
        radial.time = spec.time;
        radial.azimuth_deg = azimuth_deg;
        radial.elevation_deg = static_cast<float>(spec.elevation_deg);
        radial.nyquist_mps = spec.nyquist_mps;
        sweep.radials.push_back(radial);
        moment.gate_counts.push_back(static_cast<std::uint16_t>(spec.gates));
        for (int gate = 0; gate < spec.gates; ++gate)
            moment.codes16.push_back(
                code_of(velocity(static_cast<double>(azimuth_deg), moment.range_m(gate))));
    }
    sweep.moments.push_back(std::move(moment));
    volume.sweeps.push_back(std::move(sweep));
}

level2::Volume volume_of(const SweepSpec& spec, const SweepVelocity& velocity) {
    level2::Volume volume;
    add_sweep(volume, spec, velocity);
    return volume;
}

Dealiased no_folds(const level2::Volume& volume) {
    return dealias(volume, Dealiasing::off);
}

double turn_deg(double from_deg, double to_deg) {
    return std::remainder(to_deg - from_deg, 360.0);
}

}  // namespace stormcellar::retrieve
