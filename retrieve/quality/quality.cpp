// Computes the probability of weather at the gates of a volume.
#include "stormcellar/retrieve/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "base/memory.h"
#include "retrieve/quality/additive_rule.h"
#include "retrieve/quality/dual_source.h"
#include "retrieve/quality/echo_features.h"
#include "retrieve/quality/gate_field.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

class QualityMaker {
  public:
    QualityMaker(const level2::Volume& volume, bool only_single)
        : volume_(volume), only_single_(only_single) {}

    std::vector<SweepQuality> make() {
        // Begin with the sweeps whose results other sweeps copy.
        for (std::size_t sweep = 0; sweep < volume_.sweeps.size(); ++sweep)
            if (!copied_from(sweep)) judge(sweep);
        const std::size_t judged_count = made_.size();
        for (std::size_t sweep = 0; sweep < volume_.sweeps.size(); ++sweep)
            if (const auto from = copied_from(sweep)) copy(sweep, *from, judged_count);
        std::ranges::stable_sort(made_, {}, &SweepQuality::sweep);
        return std::move(made_);
    }
    // Judges one sweep, and the sweep whose results it copies.
    std::vector<SweepQuality> make(std::size_t sweep) {
        const auto from = copied_from(sweep);
        judge(from.value_or(sweep));
        if (from) copy(sweep, *from, made_.size());
        std::erase_if(made_, [sweep](const SweepQuality& made) { return made.sweep != sweep; });
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
            read_gate_field(from, from.moments[moment], field_);
            if (field_.is_empty()) continue;
            made_.push_back(
                {sweep, moment, judged(sweep, is_dual ? QualityRule::dual : QualityRule::single)});
        }
    }
    // Returns the probabilities of field_, a moment of the sweep.
    std::vector<float> judged(std::size_t sweep, QualityRule rule) {
        const RuleTables& tables = rule == QualityRule::dual ? dual_ : single_;
        const EchoGates echo(field_);
        log_odds_.assign(echo.count(), tables.constant());
        visit_features(volume_, sweep, field_, echo, rule, other_,
                       [&](Feature feature, std::size_t radial, std::span<const float> values) {
                           tables.add(feature, values, log_odds_.data() + echo.begin(radial));
                       });
        std::vector<float> probabilities;
        probabilities.reserve(field_.codes.size());
        prefer_large_pages(probabilities.data(), field_.codes.size() * sizeof(float));
        probabilities.assign(field_.codes.size(), no_value);
        for (std::size_t radial = 0, i = 0; radial < field_.radials; ++radial)
            for (const std::uint32_t gate : echo.of(radial))
                probabilities[radial * field_.gates + gate] = 1 / (1 + std::exp(-log_odds_[i++]));
        return probabilities;
    }
    void copy(std::size_t sweep, std::size_t from, std::size_t judged_count) {
        const level2::Sweep& to = volume_.sweeps[sweep];
        const auto source =
            std::ranges::find(std::span(made_).first(judged_count), from, &SweepQuality::sweep);
        if (source == std::span(made_).first(judged_count).end()) return;
        const level2::SweepMoment& there = volume_.sweeps[from].moments[source->moment];
        for (std::size_t moment = 0; moment < to.moments.size(); ++moment) {
            if (to.moments[moment].moment != Moment::ref) continue;
            read_gate_field(to, to.moments[moment], field_);
            made_.push_back({sweep, moment,
                             taken_values(field_, to, there, volume_.sweeps[from],
                                          source->probabilities, no_value)});
        }
    }

    const level2::Volume& volume_;
    bool only_single_;
    RuleTables dual_{taught_rule(QualityRule::dual)};
    RuleTables single_{taught_rule(QualityRule::single)};
    std::vector<SweepQuality> made_;
    // Each sweep reuses the memory of the sweep before.
    GateField field_, other_;
    std::vector<float> log_odds_;
};

}  // namespace

std::vector<SweepQuality> weather_probabilities(const level2::Volume& volume, bool only_single) {
    return QualityMaker(volume, only_single).make();
}

std::vector<SweepQuality> weather_probabilities_of(const level2::Volume& volume,
                                                   std::size_t sweep) {
    return QualityMaker(volume, false).make(sweep);
}

}  // namespace stormcellar::retrieve
