#include "tests/retrieve/folded_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"
#include "synth/synth_effects.h"

namespace stormcellar::retrieve {
namespace {

constexpr double scale = 2;  // codes are half meters a second, as the radar sends them
constexpr double offset = 129;
constexpr double first_gate_m = 2000;

grid::BeamGeometry beam_of_radar() {
    return {35, 0};
}

struct Gate {
    std::uint8_t code = 0;
    std::int8_t fold = 0;
    double true_mps = std::numeric_limits<double>::quiet_NaN();
};

// Returns what the radar measures at a gate of this true velocity. NaN stands for no echo.
Gate observe_gate(const FoldedSpec& spec, const synth::DrawPlace& place, double true_mps) {
    const synth::RandomWords words = synth::draw(spec.seed, synth::Draw::gate, place);
    Gate gate;
    if (synth::uniform_of(words[2]) < spec.missing) return gate;
    const bool is_speckle = synth::uniform_of(words[3]) < spec.speckle;
    if (std::isnan(true_mps) && !is_speckle) return gate;
    const double received_mps =
        is_speckle ? spec.nyquist_mps * (2 * synth::uniform_of(words[0]) - 1)
                   : true_mps + spec.noise_mps * synth::normals_of(words[0], words[1]).first;
    const double raw_mps =
        std::clamp(synth::wrapped_mps(received_mps, spec.nyquist_mps), -63.0, 63.0);
    gate.code = static_cast<std::uint8_t>(std::lround(raw_mps * scale + offset));
    if (is_speckle) return gate;
    gate.true_mps = true_mps;
    gate.fold = static_cast<std::int8_t>(synth::fold_number(true_mps, raw_mps, spec.nyquist_mps));
    return gate;
}

level2::Sweep sweep_of(const FoldedSpec& spec, double elevation_deg) {
    level2::Sweep sweep;
    for (int row = 0; row < spec.radials; ++row) {
        level2::Radial radial;
        radial.azimuth_deg = static_cast<float>((row + 0.5) * 360.0 / spec.radials);
        radial.elevation_deg = static_cast<float>(elevation_deg);
        radial.nyquist_mps = static_cast<float>(spec.nyquist_mps);
        sweep.radials.push_back(radial);
    }
    level2::SweepMoment moment;
    moment.moment = level2::Moment::vel;
    moment.first_gate_m = static_cast<std::int32_t>(first_gate_m);
    moment.gate_spacing_m = static_cast<std::int32_t>(spec.gate_spacing_m);
    moment.gate_stride = spec.gates;
    moment.scale = static_cast<float>(scale);
    moment.offset = static_cast<float>(offset);
    moment.gate_counts.assign(static_cast<std::size_t>(spec.radials),
                              static_cast<std::uint16_t>(spec.gates));
    sweep.moments.push_back(std::move(moment));
    return sweep;
}

}  // namespace

double scattered_mps(double azimuth_deg, double range_m, double, double) {
    return std::fmod(azimuth_deg * 7919 + range_m * 104'729, 60.0) - 30;
}

FoldedSpec one_gate_spec() {
    FoldedSpec spec;
    spec.radials = 1;
    spec.gates = 1;
    spec.missing = 0;
    return spec;
}

FoldedSpec one_legacy_sweep_spec() {
    FoldedSpec spec;
    spec.radials = 367;
    spec.elevations_deg = {0.5};
    return spec;
}

RadialVelocity along_beam(const synth::Wind& wind) {
    return [wind, beam = beam_of_radar()](double azimuth_deg, double range_m, double elevation_deg,
                                          double height_m) {
        const double arc_m = beam.forward({range_m, elevation_deg}).arc_m;
        const synth::Point point{arc_m * std::sin(azimuth_deg * degree),
                                 arc_m * std::cos(azimuth_deg * degree), height_m};
        return synth::away_mps(synth::wind_at(wind, point, 0), azimuth_deg, elevation_deg);
    };
}

FoldedVolume fold(const FoldedSpec& spec, const synth::Wind& wind) {
    return fold(spec, along_beam(wind));
}

FoldedVolume fold(const FoldedSpec& spec, const RadialVelocity& velocity) {
    const grid::BeamGeometry beam = beam_of_radar();
    FoldedVolume folded;
    for (const double elevation : spec.elevations_deg) {
        level2::Sweep sweep = sweep_of(spec, elevation);
        sweep.elevation_number = static_cast<int>(folded.volume.sweeps.size()) + 1;
        std::vector<std::int8_t> folds;
        std::vector<double> true_mps;
        synth::DrawPlace place;
        place.cut = static_cast<std::uint32_t>(sweep.elevation_number);
        for (const level2::Radial& radial : sweep.radials) {
            for (place.gate = 0; static_cast<int>(place.gate) < spec.gates; ++place.gate) {
                const double range = first_gate_m + place.gate * spec.gate_spacing_m;
                const double height = beam.forward({range, elevation}).height_m;
                const Gate gate = observe_gate(
                    spec, place,
                    velocity(static_cast<double>(radial.azimuth_deg), range, elevation, height));
                sweep.moments[0].codes8.push_back(gate.code);
                folds.push_back(gate.fold);
                true_mps.push_back(gate.true_mps);
            }
            ++place.radial;
        }
        folded.volume.sweeps.push_back(std::move(sweep));
        folded.folds.push_back(std::move(folds));
        folded.true_mps.push_back(std::move(true_mps));
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
            if (moment.codes8[i] < 2 || std::isnan(truth.true_mps[s][i])) continue;
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
