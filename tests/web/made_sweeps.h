// tests/web/made_sweeps.h -- volumes with given sweeps, without a file.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::web {

struct CutPlan {
    double angle_deg = 0.5;
    bool is_doppler = false;
    double spacing_deg = 1;
};

// Adds a moment whose codes are radial + gate + 2, so that every gate has a value.
inline void add_moment(level2::Sweep& sweep, level2::Moment moment, std::int32_t first_gate_m,
                       std::int32_t gate_spacing_m, std::int32_t gates) {
    level2::SweepMoment array;
    array.moment = moment;
    array.first_gate_m = first_gate_m;
    array.gate_spacing_m = gate_spacing_m;
    array.gate_stride = gates;
    array.scale = 2;
    array.offset = 66;
    array.gate_counts.assign(sweep.radials.size(), static_cast<std::uint16_t>(gates));
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
        for (std::int32_t gate = 0; gate < gates; ++gate)
            array.codes8.push_back(
                static_cast<std::uint8_t>((radial + static_cast<std::size_t>(gate)) % 254 + 2));
    sweep.moments.push_back(std::move(array));
}

inline level2::Sweep made_sweep(const CutPlan& plan, int elevation_number) {
    level2::Sweep sweep;
    sweep.elevation_number = elevation_number;
    sweep.vcp_elevation_deg = static_cast<float>(plan.angle_deg);
    for (double azimuth_deg = plan.spacing_deg / 2; azimuth_deg < 360;
         azimuth_deg += plan.spacing_deg) {
        level2::Radial radial;
        radial.azimuth_deg = static_cast<float>(azimuth_deg);
        radial.elevation_deg = static_cast<float>(plan.angle_deg);
        sweep.radials.push_back(radial);
    }
    add_moment(sweep, plan.is_doppler ? level2::Moment::vel : level2::Moment::ref, 0, 250, 4);
    return sweep;
}

inline level2::Volume made_volume(const std::vector<CutPlan>& cuts) {
    level2::Volume volume;
    for (const CutPlan& cut : cuts)
        volume.sweeps.push_back(made_sweep(cut, static_cast<int>(volume.sweeps.size()) + 1));
    return volume;
}

}  // namespace stormcellar::web
