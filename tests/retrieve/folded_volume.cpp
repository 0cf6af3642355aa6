#include "tests/retrieve/folded_volume.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::retrieve {
namespace {

constexpr double scale = 2;  // codes are half meters a second, as the radar sends them
constexpr double offset = 129;

struct Coded {
    std::uint16_t code = 0;
    std::int8_t fold = 0;
};

// Returns the code of the folded velocity, and the fold number that restores the true velocity.
Coded code_of(double velocity_mps, double nyquist_mps) {
    const double turn = 2 * nyquist_mps;
    const double folds = std::round(velocity_mps / turn);
    const double raw = std::clamp(velocity_mps - folds * turn, -63.0, 63.0);
    return {static_cast<std::uint16_t>(std::lround(raw * scale + offset)),
            static_cast<std::int8_t>(folds)};
}

}  // namespace

FoldedVolume fold(const FoldedSpec& spec, const RadialVelocity& velocity) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, std::max(spec.noise_mps, 1e-9));
    std::uniform_real_distribution<double> chance(0, 1);
    const grid::BeamGeometry beam(35, 0);
    FoldedVolume folded;
    for (const double elevation : spec.elevations_deg) {
        level2::Sweep sweep;
        sweep.elevation_number = static_cast<int>(folded.volume.sweeps.size()) + 1;
        level2::SweepMoment moment;
        moment.moment = level2::Moment::vel;
        moment.first_gate_m = 2000;
        moment.gate_spacing_m = static_cast<std::int32_t>(spec.gate_spacing_m);
        moment.gate_stride = spec.gates;
        moment.scale = static_cast<float>(scale);
        moment.offset = static_cast<float>(offset);
        moment.gate_counts.assign(static_cast<std::size_t>(spec.radials),
                                  static_cast<std::uint16_t>(spec.gates));
        std::vector<std::int8_t> folds;
        for (int radial = 0; radial < spec.radials; ++radial) {
            level2::Radial of;
            of.azimuth_deg = static_cast<float>((radial + 0.5) * 360.0 / spec.radials);
            of.elevation_deg = static_cast<float>(elevation);
            of.nyquist_mps = static_cast<float>(spec.nyquist_mps);
            sweep.radials.push_back(of);
            for (int gate = 0; gate < spec.gates; ++gate) {
                const double range = 2000 + gate * spec.gate_spacing_m;
                const double height = beam.forward({range, elevation}).height_m;
                const double true_mps =
                    velocity(static_cast<double>(of.azimuth_deg), range, elevation, height) +
                    noise(random);
                Coded coded;
                if (!std::isnan(true_mps) && chance(random) >= spec.missing)
                    coded = code_of(true_mps, spec.nyquist_mps);
                moment.codes8.push_back(static_cast<std::uint8_t>(coded.code));
                folds.push_back(coded.fold);
            }
        }
        sweep.moments.push_back(std::move(moment));
        folded.volume.sweeps.push_back(std::move(sweep));
        folded.folds.push_back(std::move(folds));
    }
    return folded;
}

Score score(const FoldedVolume& truth, const Dealiased& found) {
    Score score;
    for (std::size_t s = 0; s < truth.folds.size(); ++s) {
        const level2::SweepMoment& moment = truth.volume.sweeps[s].moments[0];
        const SweepFolds& folds = found.sweeps[s];
        std::int64_t gates = 0, wrong = 0;
        for (std::size_t i = 0; i < folds.folds.size(); ++i) {
            if (moment.codes8[i] < 2) continue;
            ++gates;
            const bool is_marked = folds.ambiguous[i] != 0;
            score.marked += is_marked ? 1 : 0;
            if (folds.folds[i] == truth.folds[s][i]) continue;
            ++wrong;
            score.wrong_unmarked += is_marked ? 0 : 1;
        }
        score.gates += gates;
        score.wrong += wrong;
        score.worst_sweep =
            std::max(score.worst_sweep, static_cast<double>(wrong) /
                                            static_cast<double>(std::max<std::int64_t>(gates, 1)));
    }
    return score;
}

}  // namespace stormcellar::retrieve
