// Computes the probability of weather at the gates of a volume.
#include "stormcellar/retrieve/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "retrieve/quality/additive_rule.h"
#include "retrieve/quality/echo_features.h"
#include "retrieve/quality/gate_field.h"
#include "retrieve/sweeps/nearest_sweep.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

bool has_dual_polarization(const level2::Sweep& sweep) {
    return sweep.find(Moment::rho) != nullptr && sweep.find(Moment::zdr) != nullptr &&
           sweep.find(Moment::phi) != nullptr;
}

std::vector<float> judged(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                          QualityRule rule, const RuleTables& tables) {
    const EchoGates echo(field);
    std::vector<float> log_odds(echo.count(), tables.constant());
    visit_features(volume, sweep, field, echo, rule,
                   [&](Feature feature, std::size_t radial, std::span<const float> values) {
                       tables.add(feature, values, log_odds.data() + echo.begin(radial));
                   });
    std::vector<float> probabilities(field.codes.size(), no_value);
    for (std::size_t radial = 0, i = 0; radial < field.radials; ++radial)
        for (const std::uint32_t gate : echo.of(radial))
            probabilities[radial * field.gates + gate] = 1 / (1 + std::exp(-log_odds[i++]));
    return probabilities;
}

class QualityMaker {
  public:
    QualityMaker(const level2::Volume& volume, bool only_single)
        : volume_(volume), only_single_(only_single) {}

    std::vector<SweepQuality> make() {
        // First judge the sweeps that the others copy.
        for (std::size_t sweep = 0; sweep < volume_.sweeps.size(); ++sweep)
            if (!copied_from(sweep)) judge(sweep);
        const std::size_t judged_count = made_.size();
        for (std::size_t sweep = 0; sweep < volume_.sweeps.size(); ++sweep)
            if (const auto from = copied_from(sweep)) copy(sweep, *from, judged_count);
        std::ranges::stable_sort(made_, {}, &SweepQuality::sweep);
        return std::move(made_);
    }

  private:
    // Returns the sweep with dual polarization whose probabilities a sweep without takes.
    [[nodiscard]] std::optional<std::size_t> copied_from(std::size_t sweep) const {
        if (only_single_ || has_dual_polarization(volume_.sweeps[sweep])) return std::nullopt;
        return companion_sweep(volume_, sweep, volume_.sweeps[sweep].mean_elevation_deg(),
                               Moment::rho);
    }
    void judge(std::size_t sweep) {
        const level2::Sweep& from = volume_.sweeps[sweep];
        const bool is_dual = !only_single_ && has_dual_polarization(from);
        for (std::size_t moment = 0; moment < from.moments.size(); ++moment) {
            if (from.moments[moment].moment != Moment::ref) continue;
            const GateField field = gate_field(from, from.moments[moment]);
            if (field.is_empty()) continue;
            made_.push_back(
                {sweep, moment,
                 judged(volume_, sweep, field, is_dual ? QualityRule::dual : QualityRule::single,
                        is_dual ? dual_ : single_)});
        }
    }
    void copy(std::size_t sweep, std::size_t from, std::size_t judged_count) {
        const level2::Sweep& to = volume_.sweeps[sweep];
        const auto source =
            std::ranges::find(std::span(made_).first(judged_count), from, &SweepQuality::sweep);
        if (source == std::span(made_).first(judged_count).end()) return;
        const level2::SweepMoment& there = volume_.sweeps[from].moments[source->moment];
        const auto radials = nearest_radials(azimuths_of(to), volume_.sweeps[from]);
        for (std::size_t moment = 0; moment < to.moments.size(); ++moment) {
            if (to.moments[moment].moment != Moment::ref) continue;
            const GateField field = gate_field(to, to.moments[moment]);
            made_.push_back({sweep, moment, copied_probabilities(field, radials, there, *source)});
        }
    }
    static std::vector<float> copied_probabilities(const GateField& field,
                                                   const std::vector<std::int32_t>& radials,
                                                   const level2::SweepMoment& there,
                                                   const SweepQuality& source) {
        const auto stride = static_cast<std::size_t>(there.gate_stride);
        std::vector<std::size_t> gates(field.gates);  // stride: outside
        for (std::size_t gate = 0; gate < gates.size(); ++gate) {
            const auto other =
                std::llround((field.range_m(gate) - there.first_gate_m) / there.gate_spacing_m);
            gates[gate] =
                other >= 0 && other < there.gate_stride ? static_cast<std::size_t>(other) : stride;
        }
        std::vector<float> copied(field.codes.size(), no_value);
        for (std::size_t radial = 0; radial < field.radials; ++radial) {
            if (radials[radial] < 0) continue;
            const float* from =
                source.probabilities.data() + static_cast<std::size_t>(radials[radial]) * stride;
            const std::uint16_t* codes = field.row(radial);
            for (std::size_t gate = 0; gate < field.gates; ++gate)
                if (codes[gate] != 0 && gates[gate] != stride)
                    copied[radial * field.gates + gate] = from[gates[gate]];
        }
        return copied;
    }

    const level2::Volume& volume_;
    bool only_single_;
    RuleTables dual_{taught_rule(QualityRule::dual)};
    RuleTables single_{taught_rule(QualityRule::single)};
    std::vector<SweepQuality> made_;
};

}  // namespace

std::vector<SweepQuality> weather_probabilities(const level2::Volume& volume, bool only_single) {
    return QualityMaker(volume, only_single).make();
}

}  // namespace stormcellar::retrieve
