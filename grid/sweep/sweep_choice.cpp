#include "stormcellar/grid/sweep_choice.h"

#include <algorithm>
#include <cmath>

#include "base/floating_point.h"

namespace stormcellar::grid {
namespace {

constexpr double same_elevation_deg = 0.2;
// A sweep is good enough if it has this share of the largest azimuth coverage, of the farthest
// range, and of the longest unambiguous range.
constexpr double full_enough = 0.9;
constexpr double widest_spacing_deg = 2;
constexpr double believable_vcp_error_deg = 0.5;
constexpr float lowest_elevation_deg = -10;
constexpr float highest_elevation_deg = 89;
constexpr float largest_value = 1e5F;  // for any moment, in its unit

struct Candidate {
    ChosenSweep sweep;
    double angle_deg = 0;  // the fixed angle if it is plausible, else the measured elevation
    double covered_deg = 0;
    double reach_m = 0;
    double unambiguous_m = 0;  // 0: unknown, or meaningless for the moment
};

struct Pattern {
    int number;
    std::vector<double> angles_deg;
};

// Returns the patterns of radars that sent no message with their pattern (Federal Meteorological
// Handbook 11, part C, chapter 5).
const std::vector<Pattern>& early_patterns() {
    static const std::vector<Pattern> patterns = {
        {11, {0.5, 1.45, 2.4, 3.35, 4.3, 5.25, 6.2, 7.5, 8.7, 10, 12, 14, 16.7, 19.5}},
        {12, {0.5, 0.9, 1.3, 1.8, 2.4, 3.1, 4, 5.1, 6.4, 8, 10, 12.5, 15.6, 19.5}},
        {21, {0.5, 1.45, 2.4, 3.35, 4.3, 6, 9.9, 14.6, 19.5}},
        {31, {0.5, 1.5, 2.5, 3.5, 4.5}},
        {32, {0.5, 1.5, 2.5, 3.5, 4.5}},
        {121, {0.5, 1.45, 2.4, 3.35, 4.3, 6, 9.9, 14.6, 19.5}},
    };
    return patterns;
}

// Returns false for a damaged scale, whose values would be absurd or infinite.
bool has_believable_values(const level2::SweepMoment& kind) {
    const std::uint16_t largest = kind.word_size_bits == 8 ? 255 : 65535;
    const MaskedTraps masked;
    return is_within(kind.value_of(0), -largest_value, largest_value) &&
           is_within(kind.value_of(largest), -largest_value, largest_value);
}

bool has_moment(const level2::Sweep& sweep, level2::Moment moment, std::size_t radial) {
    return std::any_of(sweep.moments.begin(), sweep.moments.end(), [&](const auto& kind) {
        return kind.moment == moment && radial < kind.gate_counts.size() &&
               kind.gate_counts[radial] > 0 && has_believable_values(kind);
    });
}

bool has_angles(const level2::Radial& radial) {
    return normal_azimuth(radial.azimuth_deg) &&
           is_within(radial.elevation_deg, lowest_elevation_deg, highest_elevation_deg);
}

template <class T>
T median(std::vector<T> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double reach_of(const level2::Sweep& sweep, level2::Moment moment) {
    double reach_m = 0;
    for (const level2::SweepMoment& kind : sweep.moments) {
        if (kind.moment == moment) reach_m = std::max(reach_m, kind.range_m(kind.gate_stride));
    }
    return reach_m;
}

// Returns the median unambiguous range, by which sweeps are chosen. Echo from beyond this range is
// lost, unless a surveillance sweep sorts it out. Returns 0 for Doppler moments, because their
// unambiguous range is always short.
double unambiguous_range_m(const level2::Sweep& sweep, level2::Moment moment,
                           std::span<const std::uint32_t> radials) {
    if (level2::facts_of(moment).is_doppler) return 0;
    std::vector<float> ranges_m;
    for (const std::uint32_t radial : radials) {
        const float range_m = sweep.radials[radial].unambiguous_range_m;
        ranges_m.push_back(std::isfinite(range_m) ? std::max(range_m, 0.0F) : 0.0F);
    }
    return ranges_m.empty() ? 0 : static_cast<double>(median(std::move(ranges_m)));
}

std::optional<UtcTime> median_time(const level2::Sweep& sweep,
                                   std::span<const std::uint32_t> radials) {
    std::vector<UtcTime> times;
    for (const std::uint32_t radial : radials) {
        const UtcTime time = sweep.radials[radial].time;
        if (level2::is_plausible(time)) times.push_back(time);
    }
    if (times.empty()) return std::nullopt;
    return median(std::move(times));
}

double covered_by(const level2::Sweep& sweep, std::span<const std::uint32_t> radials) {
    std::vector<float> azimuths_deg;
    azimuths_deg.reserve(radials.size());
    for (const std::uint32_t radial : radials)
        azimuths_deg.push_back(*normal_azimuth(sweep.radials[radial].azimuth_deg));
    std::sort(azimuths_deg.begin(), azimuths_deg.end());
    const double spacing_deg = azimuth_spacing_deg(azimuths_deg, sweep.azimuth_spacing_deg);
    return std::min(360.0, spacing_deg * static_cast<double>(radials.size()));
}

std::optional<Candidate> candidate_of(const level2::Volume& volume, std::size_t index,
                                      level2::Moment moment, double half_beam_deg) {
    const level2::Sweep& sweep = volume.sweeps[index];
    std::vector<std::uint32_t> usable;
    std::vector<float> elevations_deg;
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        if (!has_moment(sweep, moment, radial) || !has_angles(sweep.radials[radial])) continue;
        usable.push_back(static_cast<std::uint32_t>(radial));
        elevations_deg.push_back(sweep.radials[radial].elevation_deg);
    }
    if (usable.empty()) return std::nullopt;

    Candidate candidate;
    candidate.sweep.sweep_index = index;
    candidate.sweep.elevation_deg = static_cast<double>(median(elevations_deg));
    for (const std::uint32_t radial : usable) {
        const double off_deg = sweep.radials[radial].elevation_deg - candidate.sweep.elevation_deg;
        if (std::abs(off_deg) <= half_beam_deg) {
            candidate.sweep.radials.push_back(radial);
        } else {
            ++candidate.sweep.radials_off_elevation;
        }
    }
    candidate.angle_deg = candidate.sweep.elevation_deg;
    if (sweep.vcp_elevation_deg &&
        std::islessequal(std::abs(*sweep.vcp_elevation_deg - candidate.angle_deg),
                         believable_vcp_error_deg)) {
        candidate.angle_deg = static_cast<double>(*sweep.vcp_elevation_deg);
    }
    candidate.sweep.fixed_angle_deg = candidate.angle_deg;
    candidate.covered_deg = covered_by(sweep, candidate.sweep.radials);
    candidate.reach_m = reach_of(sweep, moment);
    candidate.unambiguous_m = unambiguous_range_m(sweep, moment, candidate.sweep.radials);
    candidate.sweep.median_time = median_time(sweep, candidate.sweep.radials);
    return candidate;
}

// Keeps the candidates whose `respect` (a member of Candidate) is near the largest.
void keep_near_largest(std::vector<Candidate*>& group, double Candidate::*respect) {
    double largest = 0;
    for (const Candidate* candidate : group)
        largest = std::max(largest, candidate->*respect);
    std::erase_if(group, [&](const Candidate* candidate) {
        return candidate->*respect < full_enough * largest;
    });
}

// Returns true if `later`, which comes later in the file, is better than `other`.
bool is_fitter(const ChosenSweep& later, const ChosenSweep& other,
               std::optional<UtcTime> nearest_to) {
    if (!nearest_to) return true;
    if (!later.median_time) return !other.median_time;
    if (!other.median_time) return true;
    return std::chrono::abs(*later.median_time - *nearest_to) <=
           std::chrono::abs(*other.median_time - *nearest_to);
}

// Returns the best of the sweeps at one elevation. They must be in the order of the file.
Candidate take_best(std::span<Candidate> group, std::optional<UtcTime> nearest_to) {
    std::vector<Candidate*> fit;
    for (Candidate& candidate : group)
        fit.push_back(&candidate);
    keep_near_largest(fit, &Candidate::covered_deg);
    keep_near_largest(fit, &Candidate::reach_m);
    keep_near_largest(fit, &Candidate::unambiguous_m);
    Candidate* best = fit.front();
    for (Candidate* candidate : fit) {
        if (is_fitter(candidate->sweep, best->sweep, nearest_to)) best = candidate;
    }
    best->sweep.repeats = fit.size();
    return *best;
}

bool cut_lies_between(std::span<const double> vcp_deg, double low_deg, double high_deg) {
    return std::any_of(vcp_deg.begin(), vcp_deg.end(), [&](double angle_deg) {
        return angle_deg > low_deg + same_elevation_deg &&
               angle_deg < high_deg - same_elevation_deg;
    });
}

}  // namespace

std::optional<float> normal_azimuth(float azimuth_deg) {
    if (!is_within(azimuth_deg, -360.0F, 720.0F)) return std::nullopt;
    float wrapped = std::fmod(azimuth_deg, 360.0F);
    if (wrapped < 0) wrapped += 360.0F;
    return wrapped < 360.0F ? wrapped : 0.0F;
}

double azimuth_spacing_deg(std::span<const float> azimuths_deg, float stated_deg) {
    const double stated = std::isgreater(stated_deg, 0.0F) ? static_cast<double>(stated_deg) : 0;
    std::vector<float> steps_deg;
    for (std::size_t i = 0; i + 1 < azimuths_deg.size(); ++i)
        steps_deg.push_back(azimuths_deg[i + 1] - azimuths_deg[i]);
    const double measured = steps_deg.empty() ? 0 : static_cast<double>(median(steps_deg));
    const double spacing = std::min(std::max(stated, measured), widest_spacing_deg);
    return spacing > 0 ? spacing : 1;
}

std::optional<ChosenSweep> sweep_by_number(const level2::Volume& volume, std::size_t number,
                                           level2::Moment moment, double half_beam_deg) {
    if (number >= volume.sweeps.size()) return std::nullopt;
    auto candidate = candidate_of(volume, number, moment, half_beam_deg);
    if (!candidate || candidate->sweep.radials.empty()) return std::nullopt;
    return std::move(candidate->sweep);
}

std::vector<double> vcp_angles_deg(const level2::Volume& volume) {
    std::vector<double> angles_deg;
    if (volume.vcp_message && !volume.vcp_message->cuts.empty()) {
        for (const level2::VcpCut& cut : volume.vcp_message->cuts)
            angles_deg.push_back(static_cast<double>(cut.elevation_deg));
    } else if (volume.vcp) {
        for (const Pattern& pattern : early_patterns()) {
            if (pattern.number == *volume.vcp) angles_deg = pattern.angles_deg;
        }
    }
    std::sort(angles_deg.begin(), angles_deg.end());
    return angles_deg;
}

std::vector<ChosenSweep> choose_sweeps(const level2::Volume& volume, level2::Moment moment,
                                       double half_beam_deg, std::optional<UtcTime> nearest_to) {
    std::vector<Candidate> candidates;
    for (std::size_t index = 0; index < volume.sweeps.size(); ++index) {
        if (auto candidate = candidate_of(volume, index, moment, half_beam_deg)) {
            candidates.push_back(std::move(*candidate));
        }
    }
    // This is stable, so candidates with the same angle remain in the order of the file.
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.angle_deg < b.angle_deg; });

    std::vector<Candidate> chosen;
    for (std::size_t from = 0; from < candidates.size();) {
        std::size_t to = from + 1;
        while (to < candidates.size() &&
               candidates[to].angle_deg - candidates[from].angle_deg <= same_elevation_deg)
            ++to;
        const auto group = std::span(candidates).subspan(from, to - from);
        std::sort(group.begin(), group.end(), [](const auto& a, const auto& b) {
            return a.sweep.sweep_index < b.sweep.sweep_index;
        });
        chosen.push_back(take_best(group, nearest_to));
        from = to;
    }
    std::stable_sort(chosen.begin(), chosen.end(), [](const auto& a, const auto& b) {
        return a.sweep.elevation_deg < b.sweep.elevation_deg;
    });

    const std::vector<double> vcp_deg = vcp_angles_deg(volume);
    std::vector<ChosenSweep> sweeps;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        chosen[i].sweep.adjacent_to_next =
            i + 1 == chosen.size() ||
            !cut_lies_between(vcp_deg, chosen[i].angle_deg, chosen[i + 1].angle_deg);
        sweeps.push_back(std::move(chosen[i].sweep));
    }
    return sweeps;
}

}  // namespace stormcellar::grid
