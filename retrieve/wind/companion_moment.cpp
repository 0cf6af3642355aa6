#include "retrieve/wind/companion_moment.h"

#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace stormcellar::retrieve {
namespace {

constexpr double farthest_elevation_deg = 0.3;
constexpr int azimuth_steps = 720;
constexpr double step_deg = 360.0 / azimuth_steps;
constexpr int farthest_step = 2;

// Returns the sweep that holds the moment nearest to the sheet in elevation, then in the order of
// the volume; null if there is none.
const level2::Sweep* nearest_sweep(const level2::Volume& volume, level2::Moment moment,
                                   const VelocitySheet& sheet) {
    const level2::Sweep* nearest = nullptr;
    auto least = std::tuple(farthest_elevation_deg, std::numeric_limits<std::size_t>::max());
    for (std::size_t s = 0; s < volume.sweeps.size(); ++s) {
        if (volume.sweeps[s].find(moment) == nullptr) continue;
        // A sweep is nearest to itself, whatever the elevations of its radials are.
        const double apart =
            s == sheet.sweep
                ? -1
                : std::abs(volume.sweeps[s].mean_elevation_deg() - sheet.elevation_deg);
        const std::size_t order = s > sheet.sweep ? s - sheet.sweep : sheet.sweep - s;
        if (std::isnan(apart) || std::tuple(apart, order) > least) continue;
        least = {apart, order};
        nearest = &volume.sweeps[s];
    }
    return nearest;
}

int step_of(double azimuth_deg) {
    return static_cast<int>(std::floor(azimuth_deg / step_deg)) % azimuth_steps;
}

}  // namespace

CompanionMoment::CompanionMoment(const level2::Volume& volume, level2::Moment moment,
                                 const VelocitySheet& sheet)
    : radials_(static_cast<std::size_t>(sheet.radials), -1) {
    const level2::Sweep* sweep = nearest_sweep(volume, moment, sheet);
    if (sweep == nullptr) return;
    moment_ = sweep->find(moment);
    std::array<std::int32_t, azimuth_steps> by_step{};
    by_step.fill(-1);
    for (std::size_t radial = 0; radial < sweep->radials.size(); ++radial) {
        const auto azimuth = static_cast<double>(sweep->radials[radial].azimuth_deg);
        if (!(azimuth >= 0 && azimuth <= 360)) continue;
        by_step[static_cast<std::size_t>(step_of(azimuth))] = static_cast<std::int32_t>(radial);
    }
    for (std::size_t radial = 0; radial < radials_.size(); ++radial) {
        const int step = step_of(static_cast<double>(sheet.azimuths_deg[radial]));
        for (int i = 0; i <= 2 * farthest_step && radials_[radial] < 0; ++i) {
            const int away = i % 2 == 0 ? i / 2 : -(i + 1) / 2;
            radials_[radial] =
                by_step[static_cast<std::size_t>((step + away + azimuth_steps) % azimuth_steps)];
        }
    }
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
