#include "retrieve/derived/rain_moments.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "retrieve/sweeps/nearest_sweep.h"
#include "stormcellar/retrieve/kdp.h"
#include "stormcellar/retrieve/rain_rate.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using level2::SweepMoment;

constexpr float kdp_scale = 200, kdp_offset = 32768, most_kdp = 160;
constexpr float most_error = 1;  // degrees/km
constexpr float rate_scale = 50, rate_offset = 3;
constexpr std::uint16_t unfitted_code = 2;
constexpr double largest_rate = 1300;

// Returns a moment with the gates and the flags of another moment. code_of(radial, gate, place in
// the rows) gives the codes of its valid gates.
template <class CodeOf>
SweepMoment moment_like(const SweepMoment& from, Moment moment, float scale, float offset,
                        CodeOf code_of) {
    SweepMoment made = from;
    made.moment = moment;
    made.word_size_bits = 16;
    made.scale = scale;
    made.offset = offset;
    made.codes8.clear();
    made.codes16.assign(made.gate_counts.size() * static_cast<std::size_t>(made.gate_stride), 0);
    for (std::size_t radial = 0; radial < made.gate_counts.size(); ++radial)
        for (std::int32_t gate = 0; gate < made.gate_counts[radial]; ++gate) {
            const std::size_t at = radial * static_cast<std::size_t>(made.gate_stride) +
                                   static_cast<std::size_t>(gate);
            const std::uint16_t code = from.code(radial, gate);
            made.codes16[at] = code < 2 ? code : code_of(radial, gate, at);
        }
    return made;
}

SweepMoment kdp_moment(const SweepMoment& phase, const SweepKdp& kdp) {
    return moment_like(
        phase, Moment::kdp, kdp_scale, kdp_offset, [&](std::size_t, std::int32_t, std::size_t at) {
            const float value = kdp.deg_per_km[at];
            const bool is_fitted =
                std::abs(value) <= most_kdp && kdp.error_deg_per_km[at] <= most_error;
            return is_fitted
                       ? static_cast<std::uint16_t>(std::lrint(value * kdp_scale + kdp_offset))
                       : unfitted_code;
        });
}

// Finds KDP at the gates of a sweep's reflectivity, in the sweep itself or in the nearest sweep.
class KdpBeside {
  public:
    KdpBeside(const level2::Volume& volume, const std::vector<SweepKdp>& all, std::size_t sweep) {
        const level2::Sweep& here = volume.sweeps[sweep];
        const auto companion =
            companion_sweep(volume, sweep, here.mean_elevation_deg(), Moment::phi);
        if (!companion) return;
        const auto found = std::ranges::find(all, *companion, &SweepKdp::sweep);
        if (found == all.end()) return;
        kdp_ = &*found;
        phase_ = &volume.sweeps[*companion].moments[found->moment];
        radials_.resize(here.radials.size());
        if (*companion == sweep)
            std::iota(radials_.begin(), radials_.end(), 0);
        else
            radials_ = nearest_radials(azimuths_of(here), volume.sweeps[*companion]);
    }
    // Returns the place of a gate in the rows of KDP, or none.
    [[nodiscard]] std::optional<std::size_t> place(std::size_t radial, double range_m) const {
        if (kdp_ == nullptr || radials_[radial] < 0) return std::nullopt;
        const double gate = std::round((range_m - phase_->first_gate_m) / phase_->gate_spacing_m);
        const bool is_inside = gate >= 0 && gate < phase_->gate_stride;
        if (!is_inside) return std::nullopt;
        return static_cast<std::size_t>(radials_[radial]) *
                   static_cast<std::size_t>(phase_->gate_stride) +
               static_cast<std::size_t>(gate);
    }
    [[nodiscard]] double rate(double dbz, std::optional<std::size_t> place) const {
        if (!place) return rain_by_reflectivity_mm_per_h(dbz);
        return rain_rate_mm_per_h(dbz, static_cast<double>(kdp_->deg_per_km[*place]),
                                  static_cast<double>(kdp_->error_deg_per_km[*place]));
    }

  private:
    const SweepKdp* kdp_ = nullptr;
    const SweepMoment* phase_ = nullptr;
    std::vector<std::int32_t> radials_;
};

SweepMoment rate_moment(const SweepMoment& reflectivity, const KdpBeside& kdp) {
    return moment_like(
        reflectivity, Moment::rate, rate_scale, rate_offset,
        [&](std::size_t radial, std::int32_t gate, std::size_t) {
            const auto dbz =
                static_cast<double>(reflectivity.value_of(reflectivity.code(radial, gate)));
            const double rate = kdp.rate(dbz, kdp.place(radial, reflectivity.range_m(gate)));
            const double least = std::min(rate, largest_rate);
            return std::isfinite(least) ? static_cast<std::uint16_t>(
                                              std::lrint(least * static_cast<double>(rate_scale) +
                                                         static_cast<double>(rate_offset)))
                                        : unfitted_code;
        });
}

}  // namespace

void add_rain_moments(level2::Volume& volume, std::span<const Moment> wanted) {
    const auto is_wanted = [&](Moment moment) {
        return std::ranges::find(wanted, moment) != wanted.end();
    };
    if (!is_wanted(Moment::kdp) && !is_wanted(Moment::rate)) return;
    const std::vector<SweepKdp> all = specific_differential_phases(volume);
    std::vector<std::vector<SweepMoment>> made(volume.sweeps.size());
    if (is_wanted(Moment::kdp))
        for (const SweepKdp& kdp : all)
            made[kdp.sweep].push_back(
                kdp_moment(volume.sweeps[kdp.sweep].moments[kdp.moment], kdp));
    if (is_wanted(Moment::rate))
        for (std::size_t sweep = 0; sweep < volume.sweeps.size(); ++sweep) {
            const KdpBeside kdp(volume, all, sweep);
            for (const SweepMoment& moment : volume.sweeps[sweep].moments)
                if (moment.moment == Moment::ref) made[sweep].push_back(rate_moment(moment, kdp));
        }
    for (std::size_t sweep = 0; sweep < made.size(); ++sweep)
        std::ranges::move(made[sweep], std::back_inserter(volume.sweeps[sweep].moments));
}

}  // namespace stormcellar::retrieve
