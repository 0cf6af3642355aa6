#include "retrieve/derived/read_folds.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using level2::SweepMoment;

void read_moment(const level2::Sweep& sweep, const SweepMoment& raw, const SweepMoment& dealiased,
                 SweepFolds& folds) {
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        if (!can_be_unfolded(sweep.radials[radial])) continue;
        const float turn_mps = 2 * sweep.radials[radial].nyquist_mps;
        const std::size_t row = radial * static_cast<std::size_t>(raw.gate_stride);
        for (std::int32_t gate = 0; gate < raw.gate_counts[radial]; ++gate) {
            const std::uint16_t code = dealiased.code(radial, gate);
            if (level2::status_of_code(Moment::veld, code) != level2::GateStatus::valid) continue;
            const float more_mps = dealiased.value_of(code) - raw.value_of(raw.code(radial, gate));
            const std::size_t at = row + static_cast<std::size_t>(gate);
            folds.folds[at] = static_cast<std::int8_t>(std::lrint(more_mps / turn_mps));
            folds.ambiguous[at] = 0;
        }
    }
}

}  // namespace

Dealiased read_folds(const level2::Volume& volume) {
    Dealiased found;
    for (std::size_t s = 0; s < volume.sweeps.size(); ++s) {
        const level2::Sweep& sweep = volume.sweeps[s];
        std::vector<const SweepMoment*> dealiased;  // in the order of the velocity moments
        for (const SweepMoment& moment : sweep.moments)
            if (moment.moment == Moment::veld) dealiased.push_back(&moment);
        std::size_t next = 0;
        for (std::size_t m = 0; m < sweep.moments.size(); ++m) {
            const SweepMoment& raw = sweep.moments[m];
            if (raw.moment != Moment::vel) continue;
            const std::size_t gates =
                sweep.radials.size() * static_cast<std::size_t>(raw.gate_stride);
            SweepFolds& folds = found.sweeps.emplace_back(SweepFolds{
                s, m, std::vector<std::int8_t>(gates, 0), std::vector<std::uint8_t>(gates, 1)});
            if (next < dealiased.size()) read_moment(sweep, raw, *dealiased[next++], folds);
        }
    }
    return found;
}

}  // namespace stormcellar::retrieve
