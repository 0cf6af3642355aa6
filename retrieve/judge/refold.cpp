#include "retrieve/judge/refold.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/floating_point.h"
#include "retrieve/dealias/fine_velocity.h"
#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {
namespace {

using level2::GateStatus;
using level2::SweepMoment;

std::size_t row_of(const SweepMoment& moment, std::size_t radial) {
    return radial * static_cast<std::size_t>(moment.gate_stride);
}

bool fits(const level2::Volume& volume, const std::vector<SweepFolds>& folds) {
    std::size_t next = 0;
    for (std::size_t s = 0; s < volume.sweeps.size(); ++s) {
        const level2::Sweep& sweep = volume.sweeps[s];
        for (std::size_t m = 0; m < sweep.moments.size(); ++m) {
            if (sweep.moments[m].moment != level2::Moment::vel) continue;
            if (next == folds.size()) return false;
            const SweepFolds& of = folds[next++];
            const std::size_t gates = row_of(sweep.moments[m], sweep.radials.size());
            if (of.sweep != s || of.moment != m || of.folds.size() != gates ||
                of.ambiguous.size() != gates)
                return false;
        }
    }
    return next == folds.size();
}

// Folds one moment of a sweep again. The sweep still has its real Nyquist velocities.
SweepMoment refolded(const level2::Sweep& sweep, SweepFolds& folds, double nyquist_mps) {
    constexpr int most_fold = std::numeric_limits<std::int8_t>::max();
    const SweepMoment& raw = sweep.moments[folds.moment];
    SweepMoment made = with_fine_codes(raw, row_of(raw, sweep.radials.size()));
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        const double real_mps = sweep.radials[radial].nyquist_mps;
        const bool is_lower = std::isgreater(real_mps, nyquist_mps);
        const bool is_same = real_mps == nyquist_mps;
        for (std::int32_t gate = 0; gate < raw.gate_stride; ++gate) {
            const std::size_t at = row_of(raw, radial) + static_cast<std::size_t>(gate);
            if (!is_lower && !is_same) folds.ambiguous[at] = 1;
            if (raw.status(radial, gate) != GateStatus::valid) {
                made.codes16[at] = gate < raw.gate_counts[radial] ? raw.code(radial, gate) : 0;
                continue;
            }
            double velocity_mps = raw.value_of(raw.code(radial, gate));
            if (is_lower) {
                velocity_mps += 2 * folds.folds[at] * real_mps;
                const double fold = std::nearbyint(velocity_mps / (2 * nyquist_mps));
                const bool is_stored = std::abs(fold) <= most_fold;
                folds.folds[at] = is_stored ? static_cast<std::int8_t>(fold) : std::int8_t{0};
                if (!is_stored) folds.ambiguous[at] = 1;
                velocity_mps -= 2 * fold * nyquist_mps;
            }
            made.codes16[at] = fine_velocity_code(velocity_mps);
        }
    }
    return made;
}

double share(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Counts the jumps of a gate to the next gate of its radial, and to the gate of the next radial.
std::int64_t jumps_of(const level2::Sweep& sweep, const SweepFolds& folds) {
    const SweepMoment& moment = sweep.moments[folds.moment];
    const std::size_t radials = sweep.radials.size();
    const auto velocity = [&](std::size_t radial, std::int32_t gate) {
        if (moment.status(radial, gate) != GateStatus::valid)
            return std::numeric_limits<float>::quiet_NaN();
        const std::size_t at = row_of(moment, radial) + static_cast<std::size_t>(gate);
        return moment.value_of(moment.code(radial, gate)) +
               2 * sweep.radials[radial].nyquist_mps * static_cast<float>(folds.folds[at]);
    };
    std::int64_t jumps = 0;
    for (std::size_t radial = 0; radial < radials; ++radial) {
        const float nyquist_mps = sweep.radials[radial].nyquist_mps;
        if (!std::isgreater(nyquist_mps, 0.0F)) continue;
        for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate) {
            const float here = velocity(radial, gate);
            for (const float other :
                 {velocity(radial, gate + 1), velocity((radial + 1) % radials, gate)})
                jumps += std::isgreater(std::abs(here - other), nyquist_mps) ? 1 : 0;
        }
    }
    return jumps;
}

}  // namespace

Result<KnownVolume> refold(const KnownVolume& known, double nyquist_mps) {
    if (!is_within<double>(nyquist_mps, least_nyquist_mps, most_nyquist_mps)) {
        return fail(ErrorCode::bad_argument, "a Nyquist velocity must be from {} to {} m/s",
                    least_nyquist_mps, most_nyquist_mps);
    }
    if (!fits(known.volume, known.folds))
        return fail(ErrorCode::bad_argument, "the fold numbers are those of another volume");
    KnownVolume made = known;
    for (SweepFolds& folds : made.folds) {
        level2::Sweep& sweep = made.volume.sweeps[folds.sweep];
        sweep.moments[folds.moment] = refolded(sweep, folds, nyquist_mps);
    }
    for (level2::Sweep& sweep : made.volume.sweeps) {
        for (level2::Radial& radial : sweep.radials)
            if (std::isgreater(static_cast<double>(radial.nyquist_mps), nyquist_mps))
                radial.nyquist_mps = static_cast<float>(nyquist_mps);
    }
    return made;
}

double FoldScore::wrong_share() const {
    return share(wrong, known);
}

double FoldScore::ambiguous_share() const {
    return share(ambiguous, gates);
}

double FoldScore::wrong_unmarked_share() const {
    return share(wrong_unmarked, known_unmarked);
}

FoldScore score_folds(const KnownVolume& known, const Dealiased& found) {
    FoldScore score;
    for (std::size_t i = 0; i < std::min(known.folds.size(), found.sweeps.size()); ++i) {
        const SweepFolds &truth = known.folds[i], &folds = found.sweeps[i];
        const level2::Sweep& sweep = known.volume.sweeps[truth.sweep];
        const SweepMoment& moment = sweep.moments[truth.moment];
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
            for (std::int32_t gate = 0; gate < moment.gate_counts[radial]; ++gate) {
                if (moment.status(radial, gate) != GateStatus::valid) continue;
                const std::size_t at = row_of(moment, radial) + static_cast<std::size_t>(gate);
                const int marked = folds.ambiguous[at] != 0 ? 1 : 0;
                ++score.gates;
                score.ambiguous += marked;
                if (truth.ambiguous[at] != 0) continue;
                const int wrong = truth.folds[at] != folds.folds[at] ? 1 : 0;
                ++score.known;
                score.wrong += wrong;
                score.known_unmarked += 1 - marked;
                score.wrong_unmarked += (1 - marked) * wrong;
            }
        }
    }
    return score;
}

std::int64_t count_jumps(const level2::Volume& volume, const Dealiased& found) {
    std::int64_t jumps = 0;
    for (const SweepFolds& folds : found.sweeps)
        jumps += jumps_of(volume.sweeps[folds.sweep], folds);
    return jumps;
}

}  // namespace stormcellar::retrieve
