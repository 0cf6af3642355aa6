// tests/grid/volume_maker.h -- makes small volumes in which every gate is known.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

// Codes of reflectivity have scale 2 and offset 66, so code 66 is 0 dBZ.
inline constexpr std::uint16_t below_threshold = 0;
inline constexpr std::uint16_t range_folded = 1;
[[nodiscard]] constexpr std::uint16_t ref_code(double dbz) {
    return static_cast<std::uint16_t>(dbz * 2 + 66);
}

struct SweepPlan {
    double elevation_deg = 0.5;
    int cut = 1;
    int radials = 360;
    double spacing_deg = 1;
    double first_azimuth_deg = 0.5;
    int gates = 300;
    int first_gate_m = 0;
    int gate_spacing_m = 1000;
    level2::Moment moment = level2::Moment::ref;
    int word_size_bits = 8;
    // Returns the code of a gate.
    std::function<std::uint16_t(int radial, int gate)> code = [](int, int) { return ref_code(20); };
};

// Returns copies of a plan at each of the elevations, as cuts 1, 2, 3 ...
[[nodiscard]] inline std::vector<SweepPlan> plans_at(const std::vector<double>& elevations_deg,
                                                     SweepPlan like = {}) {
    std::vector<SweepPlan> plans;
    for (const double elevation_deg : elevations_deg) {
        like.elevation_deg = elevation_deg;
        like.cut = static_cast<int>(plans.size()) + 1;
        plans.push_back(like);
    }
    return plans;
}

[[nodiscard]] inline level2::Sweep make_sweep(const SweepPlan& plan) {
    level2::Sweep sweep;
    sweep.elevation_number = plan.cut;
    sweep.azimuth_spacing_deg = static_cast<float>(plan.spacing_deg);
    level2::SweepMoment moment;
    moment.moment = plan.moment;
    moment.first_gate_m = plan.first_gate_m;
    moment.gate_spacing_m = plan.gate_spacing_m;
    moment.gate_stride = plan.gates;
    moment.word_size_bits = plan.word_size_bits;
    moment.scale = 2;
    moment.offset = 66;
    for (int i = 0; i < plan.radials; ++i) {
        level2::Radial radial;
        radial.time =
            time_from_nexrad(19000, static_cast<std::uint32_t>(plan.cut * 20000 + i * 50));
        const double azimuth_deg = plan.first_azimuth_deg + i * plan.spacing_deg;
        radial.azimuth_deg =
            static_cast<float>(azimuth_deg >= 360 ? azimuth_deg - 360 : azimuth_deg);
        radial.elevation_deg = static_cast<float>(plan.elevation_deg);
        sweep.radials.push_back(radial);
        moment.gate_counts.push_back(static_cast<std::uint16_t>(plan.gates));
        for (int gate = 0; gate < plan.gates; ++gate) {
            const std::uint16_t code = plan.code(i, gate);
            if (plan.word_size_bits == 8) {
                moment.codes8.push_back(static_cast<std::uint8_t>(code));
            } else {
                moment.codes16.push_back(code);
            }
        }
    }
    sweep.moments.push_back(std::move(moment));
    return sweep;
}

[[nodiscard]] inline level2::Volume make_volume(const std::vector<SweepPlan>& plans) {
    level2::Volume volume;
    volume.station = "KTLX";
    for (const SweepPlan& plan : plans)
        volume.sweeps.push_back(make_sweep(plan));
    return volume;
}

template <class Change>
void change_radials(level2::Volume& volume, Change change) {
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::Radial& radial : sweep.radials)
            change(radial);
    }
}

inline void turn_clockwise(level2::Volume& volume, float by_deg) {
    change_radials(volume, [by_deg](level2::Radial& radial) {
        radial.azimuth_deg = std::fmod(radial.azimuth_deg + by_deg, 360.0F);
    });
}

}  // namespace stormcellar::grid
