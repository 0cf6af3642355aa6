// Computes the probability of weather at the gates of a volume.
#include "stormcellar/retrieve/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "retrieve/quality/additive_rule.h"
#include "retrieve/quality/dual_source.h"
#include "retrieve/quality/echo_features.h"
#include "retrieve/quality/gate_field.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

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
    [[nodiscard]] std::optional<std::size_t> copied_from(std::size_t sweep) const {
        return only_single_ ? std::nullopt : dual_source(volume_, sweep);
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
        for (std::size_t moment = 0; moment < to.moments.size(); ++moment) {
            if (to.moments[moment].moment != Moment::ref) continue;
            const GateField field = gate_field(to, to.moments[moment]);
            made_.push_back({sweep, moment,
                             taken_values(field, to, there, volume_.sweeps[from],
                                          source->probabilities, no_value)});
        }
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
