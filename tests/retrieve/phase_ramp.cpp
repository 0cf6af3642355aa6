#include "tests/retrieve/phase_ramp.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using level2::SweepMoment;

constexpr double spacing_km = 0.25, first_km = 2.125;

SweepMoment empty_moment(Moment moment, int bits, float scale, float offset) {
    SweepMoment made;
    made.moment = moment;
    made.first_gate_m = 2125;
    made.gate_spacing_m = 250;
    made.gate_stride = ramp_gates;
    made.word_size_bits = bits;
    made.scale = scale;
    made.offset = offset;
    made.gate_counts.assign(ramp_radials, ramp_gates);
    const auto codes = static_cast<std::size_t>(ramp_radials * ramp_gates);
    if (bits == 8)
        made.codes8.assign(codes, 0);
    else
        made.codes16.assign(codes, 0);
    return made;
}

bool is_in_gap(int gate) {
    return gate % 40 < 4 || (gate >= 200 && gate < 230);
}

}  // namespace

double ramp_range_km(int gate) {
    return first_km + spacing_km * gate;
}

level2::Volume volume_of_ramp(const PhaseRamp& ramp) {
    level2::Volume volume;
    level2::Sweep& sweep = volume.sweeps.emplace_back();
    SweepMoment phase = empty_moment(Moment::phi, 16, 2.8361F, 2);
    SweepMoment correlation = empty_moment(Moment::rho, 8, 300, -60.5F);
    std::mt19937 random(1);  // NOLINT: the same noise in each run
    std::normal_distribution<double> noise(0, ramp.noise_deg);
    std::uniform_real_distribution<double> chance(0, 1);
    for (int radial = 0; radial < ramp_radials; ++radial) {
        sweep.radials.emplace_back().azimuth_deg = static_cast<float>(radial);
        double along_deg = ramp.first_deg;
        for (int gate = 0; gate < ramp_gates; ++gate) {
            const double km = ramp_range_km(gate), half_deg = ramp.kdp(km) * spacing_km;
            along_deg += half_deg;
            const double from_bump = (km - 52) / 0.6;
            double deg = along_deg + noise(random) +
                         ramp.backscatter_deg * std::exp(-0.5 * from_bump * from_bump);
            along_deg += half_deg;
            double rho = 0.99;
            if (chance(random) < ramp.speckle) {
                deg = 360 * chance(random);
                rho = chance(random) < 0.8 ? 0.6 : rho;
            }
            if (ramp.has_gaps && is_in_gap(gate)) continue;
            deg -= 360 * std::floor(deg / 360);
            const auto at = static_cast<std::size_t>(radial * ramp_gates + gate);
            phase.codes16[at] = static_cast<std::uint16_t>(std::lrint(deg * 2.8361) + 2);
            correlation.codes8[at] = static_cast<std::uint8_t>(std::lrint(rho * 300 - 60.5));
        }
    }
    sweep.moments = {phase, correlation};
    return volume;
}

}  // namespace stormcellar::retrieve
