#include "retrieve/sweeps/nearest_sweep.h"

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

int step_of(double azimuth_deg) {
    return static_cast<int>(std::floor(azimuth_deg / step_deg)) % azimuth_steps;
}

std::int64_t last_gate_m(const level2::SweepMoment& moment) {
    return moment.first_gate_m + std::int64_t{moment.gate_spacing_m} * moment.gate_stride;
}

}  // namespace

std::optional<std::size_t> companion_sweep(const level2::Volume& volume, std::size_t sweep,
                                           double elevation_deg, level2::Moment moment) {
    std::optional<std::size_t> nearest;
    auto least = std::tuple(std::numeric_limits<long>::max(), std::size_t{0});
    for (std::size_t other = 0; other < volume.sweeps.size(); ++other) {
        if (volume.sweeps[other].find(moment) == nullptr) continue;
        // A sweep is its own companion, whatever the elevations of its radials are.
        if (other == sweep) return other;
        const double apart = std::abs(volume.sweeps[other].mean_elevation_deg() - elevation_deg);
        if (!(apart <= farthest_elevation_deg)) continue;
        const std::size_t order = other > sweep ? other - sweep : sweep - other;
        const auto distance = std::tuple(std::lround(10 * apart), order);
        if (distance >= least) continue;
        least = distance;
        nearest = other;
    }
    return nearest;
}

std::optional<std::size_t> sweep_above(const level2::Volume& volume, std::size_t sweep) {
    constexpr double least_step_deg = 0.3, same_deg = 0.2;
    const double elevation = volume.sweeps[sweep].mean_elevation_deg();
    const auto is_above = [&](const level2::Sweep& other) {
        return other.find(level2::Moment::ref) != nullptr &&
               other.mean_elevation_deg() > elevation + least_step_deg;
    };
    double lowest = std::numeric_limits<double>::infinity();
    for (const level2::Sweep& other : volume.sweeps)
        if (is_above(other)) lowest = std::min(lowest, other.mean_elevation_deg());
    std::optional<std::size_t> above;
    auto most = std::tuple(std::size_t{0}, std::int64_t{0});
    for (std::size_t i = 0; i < volume.sweeps.size(); ++i) {
        const level2::Sweep& other = volume.sweeps[i];
        if (!is_above(other) || other.mean_elevation_deg() > lowest + same_deg) continue;
        const auto size =
            std::tuple(other.radials.size(), last_gate_m(*other.find(level2::Moment::ref)));
        if (above && size <= most) continue;
        most = size;
        above = i;
    }
    return above;
}

std::vector<std::int32_t> nearest_radials(std::span<const float> azimuths_deg,
                                          const level2::Sweep& sweep) {
    std::array<std::int32_t, azimuth_steps> by_step{};
    by_step.fill(-1);
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        const auto azimuth = static_cast<double>(sweep.radials[radial].azimuth_deg);
        if (!(azimuth >= 0 && azimuth <= 360)) continue;
        by_step[static_cast<std::size_t>(step_of(azimuth))] = static_cast<std::int32_t>(radial);
    }
    std::vector<std::int32_t> radials(azimuths_deg.size(), -1);
    for (std::size_t i = 0; i < radials.size(); ++i) {
        const auto azimuth = static_cast<double>(azimuths_deg[i]);
        if (!(azimuth >= 0 && azimuth <= 360)) continue;
        const int step = step_of(azimuth);
        for (int look = 0; look <= 2 * farthest_step && radials[i] < 0; ++look) {
            const int away = look % 2 == 0 ? look / 2 : -(look + 1) / 2;
            radials[i] =
                by_step[static_cast<std::size_t>((step + away + azimuth_steps) % azimuth_steps)];
        }
    }
    return radials;
}

std::vector<float> azimuths_of(const level2::Sweep& sweep) {
    std::vector<float> azimuths;
    azimuths.reserve(sweep.radials.size());
    for (const level2::Radial& radial : sweep.radials)
        azimuths.push_back(radial.azimuth_deg);
    return azimuths;
}

}  // namespace stormcellar::retrieve
