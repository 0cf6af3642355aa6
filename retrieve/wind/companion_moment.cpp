#include "retrieve/wind/companion_moment.h"

#include <cmath>
#include <limits>

#include "retrieve/sweeps/nearest_sweep.h"

namespace stormcellar::retrieve {

CompanionMoment::CompanionMoment(const level2::Volume& volume, level2::Moment moment,
                                 const VelocitySheet& sheet)
    : radials_(static_cast<std::size_t>(sheet.radials), -1) {
    const auto companion = companion_sweep(volume, sheet.sweep, sheet.elevation_deg, moment);
    if (!companion) return;
    const level2::Sweep& sweep = volume.sweeps[*companion];
    moment_ = sweep.find(moment);
    radials_ = nearest_radials(sheet.azimuths_deg, sweep);
}

float CompanionMoment::at(int radial, double range_m) const {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    const std::int32_t other = radials_[static_cast<std::size_t>(radial)];
    if (other < 0 || moment_->gate_spacing_m <= 0) return none;
    const auto gate = static_cast<std::int32_t>(
        std::lround((range_m - moment_->first_gate_m) / moment_->gate_spacing_m));
    const auto row = static_cast<std::size_t>(other);
    if (moment_->status(row, gate) != level2::GateStatus::valid) return none;
    return moment_->value_of(moment_->code(row, gate));
}

}  // namespace stormcellar::retrieve
