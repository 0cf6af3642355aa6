#include "retrieve/derived/shear_moments.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "stormcellar/retrieve/velocity_shear.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using level2::SweepMoment;

// Values are in units of 0.001 s^-1, in steps of 0.01. Code 32768 is 0.
constexpr float codes_per_unit = 100, zero_code = 32768;
constexpr double codes_per_s = 1e5;
constexpr float greatest_per_s = 0.32F;
constexpr std::uint16_t no_value_code = 2;  // ambiguous

std::uint16_t shear_code(std::uint16_t dealiased_code, bool is_fitted, float per_s) {
    if (dealiased_code < level2::facts_of(Moment::veld).first_valid_code) return dealiased_code;
    const bool has_value = is_fitted && std::abs(per_s) <= greatest_per_s;
    if (!has_value) return no_value_code;
    const double steps = codes_per_s * static_cast<double>(per_s);
    return static_cast<std::uint16_t>(std::lrint(steps) + std::lrint(zero_code));
}

SweepMoment shear_moment(const SweepMoment& dealiased, const SweepShear& shear, Moment moment) {
    const std::vector<float>& values =
        moment == Moment::azsh ? shear.azimuthal_per_s : shear.divergence_per_s;
    SweepMoment made = dealiased;
    made.moment = moment;
    made.scale = codes_per_unit;
    made.offset = zero_code;
    for (std::size_t radial = 0; radial < made.gate_counts.size(); ++radial) {
        const std::size_t row = radial * static_cast<std::size_t>(made.gate_stride);
        for (std::size_t at = row; at < row + made.gate_counts[radial]; ++at)
            made.codes16[at] =
                shear_code(dealiased.codes16[at], shear.is_fitted[at] != 0, values[at]);
    }
    return made;
}

}  // namespace

Result<bool> add_shear_moments(level2::Volume& volume, const Dealiased& dealiased,
                               std::span<const Moment> wanted) {
    std::vector<Moment> moments;
    for (const Moment moment : {Moment::azsh, Moment::divg})
        if (std::ranges::find(wanted, moment) != wanted.end()) moments.push_back(moment);
    if (moments.empty()) return false;
    for (const SweepFolds& folds : dealiased.sweeps) {
        const auto shear = sweep_shear(volume, folds);
        if (!shear) return pass_on(shear);
        std::vector<SweepMoment>& all = volume.sweeps[folds.sweep].moments;
        // A sweep may hold VEL several times; the VELD of each has its rows, in the same order.
        const auto velocities =
            std::count_if(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(folds.moment),
                          [](const SweepMoment& kind) { return kind.moment == Moment::vel; });
        std::ptrdiff_t before = 0;
        const auto from = std::ranges::find_if(all, [&](const SweepMoment& kind) {
            return kind.moment == Moment::veld && before++ == velocities;
        });
        if (from == all.end()) continue;
        std::vector<SweepMoment> made;
        for (const Moment moment : moments)
            made.push_back(shear_moment(*from, *shear, moment));
        std::ranges::move(made, std::back_inserter(all));
    }
    return true;
}

}  // namespace stormcellar::retrieve
