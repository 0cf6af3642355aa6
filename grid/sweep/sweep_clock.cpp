#include "grid/sweep/sweep_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stormcellar::grid {
namespace {

// Returns the angle from one azimuth clockwise to another, in [0, 360).
double turn(double from_deg, double to_deg) {
    double apart = to_deg - from_deg;
    if (std::abs(apart) >= 360) apart = std::fmod(apart, 360.0);
    return apart < 0 ? apart + 360 : apart;
}

// Returns how far the antenna turned from the first radial to the last, as the sum of the steps. A
// step of more than half a turn counts as a step back.
double turned(const level2::Sweep& sweep, const std::vector<std::uint32_t>& radials) {
    double sum = 0;
    for (std::size_t at = 1; at < radials.size(); ++at) {
        const double step = turn(static_cast<double>(sweep.radials[radials[at - 1]].azimuth_deg),
                                 static_cast<double>(sweep.radials[radials[at]].azimuth_deg));
        sum += step < 180 ? step : step - 360;
    }
    return sum;
}

}  // namespace

std::vector<SweepTime> sweep_times(const level2::Volume& volume,
                                   std::span<const ChosenSweep> sweeps) {
    std::vector<SweepTime> times;
    const std::optional<UtcTime> start = volume.start_time();
    for (const ChosenSweep& chosen : sweeps) {
        const level2::Sweep& sweep = volume.sweeps[chosen.sweep_index];
        std::vector<std::uint32_t> dated;
        for (const std::uint32_t radial : chosen.radials) {
            if (level2::is_time_of_volume(sweep.radials[radial].time, start))
                dated.push_back(radial);
        }
        if (dated.empty()) continue;
        const level2::Radial& first = sweep.radials[dated.front()];
        const auto azimuth = normal_azimuth(first.azimuth_deg);
        if (!azimuth) continue;
        const double seconds = seconds_between(first.time, sweep.radials[dated.back()].time);
        const double degrees = turned(sweep, dated);
        const bool known =
            seconds > 0 && degrees > 0 && degrees / seconds <= fastest_turn_deg_per_s;
        times.push_back({chosen.elevation_deg, first.time, static_cast<double>(*azimuth),
                         known ? degrees / seconds : 0});
    }
    return times;
}

std::optional<SweepClock> SweepClock::of_volume(std::span<const SweepTime> sweeps,
                                                BeamGeometry beam, UtcTime origin, UtcTime middle) {
    constexpr double farthest_s = 600;
    if (sweeps.empty()) return std::nullopt;
    SweepClock clock(sweeps, beam, origin);
    const double middle_s = seconds_between(origin, middle);
    const bool is_near =
        clock.earliest_s() >= middle_s - farthest_s && clock.latest_s() <= middle_s + farthest_s;
    if (!is_near) return std::nullopt;
    return clock;
}

SweepClock::SweepClock(std::span<const SweepTime> sweeps, BeamGeometry beam, UtcTime origin)
    : beam_(beam) {
    earliest_s_ = seconds_between(origin, sweeps.front().start);
    latest_s_ = earliest_s_;
    for (const SweepTime& sweep : sweeps) {
        const double start = seconds_between(origin, sweep.start);
        const double end = sweep.degrees_per_s > 0 ? start + 360 / sweep.degrees_per_s : start;
        earliest_s_ = std::min(earliest_s_, start);
        latest_s_ = std::max(latest_s_, end);
        sweeps_.push_back({BeamGeometry::elevation_angle(sweep.elevation_deg), start,
                           sweep.first_azimuth_deg, sweep.degrees_per_s});
    }
}

double SweepClock::seconds_of(const Turn& sweep, double azimuth_deg) {
    if (!(sweep.degrees_per_s > 0)) return sweep.start_s;
    return sweep.start_s + turn(sweep.first_azimuth_deg, azimuth_deg) / sweep.degrees_per_s;
}

// Goes up the column and through the sweeps at the same time. `below` and `above` are the beams
// around a level. Below the first beam and above the last, only the nearer beam counts.
void SweepClock::read(double azimuth_deg, double arc_m, std::span<const double> levels_m,
                      std::span<float> seconds) const {
    const BeamGeometry::Angle half_arc = beam_.half_arc_angle(arc_m);
    std::size_t next = 0;  // the lowest sweep that is above the level
    double below_m = 0, below_s = 0, above_m = 0, above_s = 0;
    const auto take_next = [&] {
        below_m = above_m;
        below_s = above_s;
        if (next < sweeps_.size()) {
            above_m = beam_.height_over(half_arc, sweeps_[next].elevation);
            above_s = seconds_of(sweeps_[next], azimuth_deg);
        }
    };
    take_next();
    for (std::size_t level = 0; level < levels_m.size(); ++level) {
        while (next < sweeps_.size() && !(levels_m[level] <= above_m)) {
            ++next;
            take_next();
        }
        double time = above_s;
        if (next == sweeps_.size()) {
            time = below_s;
        } else if (next > 0 && above_m > below_m) {
            const double share = (levels_m[level] - below_m) / (above_m - below_m);
            time = below_s + share * (above_s - below_s);
        }
        seconds[level] = static_cast<float>(time);
    }
}

}  // namespace stormcellar::grid
