#include "synth/velocity_truth.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "synth/radial_observer.h"

namespace stormcellar::synth {
namespace {

Scene sampled_by(const Scene& scene, VelocitySample sample) {
    Scene sampled = scene;
    if (sample == VelocitySample::gate) return sampled;
    sampled.instrument.beam_width_deg = 0;
    sampled.instrument.pulse_length_m = 0;
    sampled.instrument.clutter.reset();
    return sampled;
}

std::int8_t fold_at(const level2::Sweep& sweep, const level2::SweepMoment& moment, std::size_t row,
                    std::int32_t gate, double true_mps) {
    const double nyquist = sweep.radials[row].nyquist_mps;
    if (moment.status(row, gate) != level2::GateStatus::valid || !(nyquist > 0)) return 0;
    const double shown_mps = moment.value_of(moment.code(row, gate));
    return static_cast<std::int8_t>(fold_number(true_mps, shown_mps, nyquist));
}

}  // namespace

VelocityTruth velocity_truth(const Scene& scene, const level2::Sweep& sweep,
                             VelocitySample sample) {
    const auto& cuts = scene.schedule.pattern.cuts;
    const level2::SweepMoment* moment = sweep.find(level2::Moment::vel);
    const int cut = sweep.elevation_number;
    if (moment == nullptr || sweep.radials.empty() || cut < 1 ||
        cut > static_cast<int>(cuts.size())) {
        return {};
    }
    const Scene sampled = sampled_by(scene, sample);
    const grid::BeamGeometry beam(scene.site.latitude_deg, scene.site.antenna_altitude_m);
    RadialObserver observer(sampled, beam, cuts[static_cast<std::size_t>(cut - 1)],
                            sweep.radials.front(), {0, cut, 1});
    VelocityTruth truth;
    const auto stride = static_cast<std::size_t>(moment->gate_stride);
    truth.away_mps.assign(sweep.radials.size() * stride, std::numeric_limits<double>::quiet_NaN());
    truth.folds.assign(truth.away_mps.size(), 0);
    for (std::size_t row = 0; row < sweep.radials.size(); ++row) {
        const level2::Radial& radial = sweep.radials[row];
        observer.sample(radial,
                        std::chrono::duration<double>(radial.time - scene.schedule.start).count());
        const auto& echoes = observer.echoes();
        for (std::size_t gate = 0; gate < std::min(stride, echoes.size()); ++gate) {
            if (echoes[gate].dbz == no_echo_dbz) continue;
            const std::size_t at = row * stride + gate;
            truth.away_mps[at] = echoes[gate].away_mps;
            truth.folds[at] = fold_at(sweep, *moment, row, static_cast<std::int32_t>(gate),
                                      echoes[gate].away_mps);
        }
    }
    return truth;
}

}  // namespace stormcellar::synth
