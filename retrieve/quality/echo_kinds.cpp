// Names echo that is not weather, from features of the gates, spokes and the extent of the echo.
#include "stormcellar/retrieve/echo_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "retrieve/quality/dual_source.h"
#include "retrieve/quality/echo_features.h"
#include "retrieve/quality/gate_field.h"
#include "retrieve/quality/spokes.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::retrieve {
namespace {

// The features of all gates with echo of a sweep.
class FeatureColumns {
  public:
    FeatureColumns(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                   const EchoGates& echo, QualityRule rule, GateField& scratch) {
        for (std::vector<float>& column : columns_)
            column.assign(echo.count(), std::numeric_limits<float>::quiet_NaN());
        visit_kind_features(
            volume, sweep, field, echo, rule, scratch,
            [&](Feature feature, std::size_t radial, std::span<const float> of) {
                std::ranges::copy(
                    of, column(feature).begin() + static_cast<std::ptrdiff_t>(echo.begin(radial)));
            });
    }
    [[nodiscard]] float at(Feature feature, std::size_t i) const {
        return columns_[static_cast<std::size_t>(feature)][i];
    }

  private:
    std::vector<float>& column(Feature feature) {
        return columns_[static_cast<std::size_t>(feature)];
    }
    std::array<std::vector<float>, feature_count> columns_;
};

// Facts that all gates of a sweep share.
struct SweepFacts {
    bool is_lowest = false;  // within 1.2 degrees of the lowest elevation of the volume
    bool has_sweep_above = false;
    bool has_dual = false;
    bool is_in_bloom = false;
};

// Features of one gate.
class GateFacts {
  public:
    GateFacts(const FeatureColumns& columns, std::size_t i, double range_m)
        : columns_(columns), i_(i), range_m_(range_m) {}
    // Missing features are neither at most nor at least a number.
    [[nodiscard]] bool at_most(Feature feature, float most) const {
        return std::islessequal(columns_.at(feature, i_), most);
    }
    [[nodiscard]] bool at_least(Feature feature, float least) const {
        return std::isgreaterequal(columns_.at(feature, i_), least);
    }
    [[nodiscard]] float operator[](Feature feature) const { return columns_.at(feature, i_); }
    [[nodiscard]] double range_m() const { return range_m_; }

  private:
    const FeatureColumns& columns_;
    std::size_t i_;
    double range_m_;
};

constexpr double near_m = 60'000, farthest_ground_m = 230'000;

bool stands_still(const GateFacts& gate) {
    return gate.at_most(Feature::speed, 1) && gate.at_most(Feature::speed_texture, 1.5F) &&
           gate.at_most(Feature::width, 2) && gate.at_least(Feature::range_texture, 3);
}

bool is_ground_clutter(const GateFacts& gate) {
    return gate.range_m() <= near_m && gate.at_most(Feature::height, 2000) && stands_still(gate);
}

bool is_distant_ground(const GateFacts& gate, const SweepFacts& sweep) {
    if (gate.range_m() <= near_m || gate.range_m() > farthest_ground_m) return false;
    if (!sweep.is_lowest || !sweep.has_sweep_above || !stands_still(gate)) return false;
    const float above = gate[Feature::reflectivity_above];
    return std::isnan(above) || gate[Feature::reflectivity] - above >= 15;
}

bool is_birds_and_insects(const GateFacts& gate, const SweepFacts& sweep) {
    const bool is_smooth_and_low =
        gate.at_most(Feature::height, 3000) && gate.at_least(Feature::echo_share, 0.5F) &&
        gate.at_most(Feature::range_texture, 7) && gate.at_least(Feature::speed_share, 0.7F) &&
        gate.at_most(Feature::speed_texture, 5);
    if (!is_smooth_and_low) return false;
    if (sweep.has_dual)
        return gate.at_most(Feature::reflectivity, 35) &&
               std::isless(gate[Feature::correlation], 0.9F) &&
               gate.at_least(Feature::phase_texture, 8);
    return sweep.is_in_bloom && gate.at_most(Feature::reflectivity, 30) &&
           gate.at_least(Feature::echo_share, 0.8F) && gate.at_least(Feature::speed_share, 0.8F) &&
           gate.at_least(Feature::width, 2);
}

EchoKind kind_of(const GateFacts& gate, const SweepFacts& sweep) {
    if (is_ground_clutter(gate)) return EchoKind::ground_clutter;
    if (is_distant_ground(gate, sweep)) return EchoKind::distant_ground;
    if (is_birds_and_insects(gate, sweep)) return EchoKind::birds_and_insects;
    return EchoKind::other;
}

// Counts the gates, and the gates with echo, in a layer about the radar.
struct LayerCount {
    double bottom_m = 0, top_m = 0;
    std::int64_t gates = 0, echo = 0;

    [[nodiscard]] double share() const {
        return static_cast<double>(echo) / static_cast<double>(gates);
    }
};

// Returns true if echo is all around the radar near the ground, and hardly above.
bool has_bloom(const level2::Volume& volume, std::span<const SweepQuality> qualities) {
    constexpr double first_m = 10'000, last_m = 60'000;
    LayerCount low{200, 1000}, aloft{3000, 6000};
    const grid::BeamGeometry beam(40, 0);
    for (const SweepQuality& quality : qualities) {
        const level2::Sweep& sweep = volume.sweeps[quality.sweep];
        const GateField field = gate_field(sweep, sweep.moments[quality.moment]);
        const double elevation = sweep.mean_elevation_deg();
        if (!std::isfinite(elevation)) continue;
        for (std::size_t gate = 0; gate < field.gates; ++gate) {
            const double range = field.range_m(gate);
            if (range < first_m || range > last_m) continue;
            const double height = beam.forward({range, elevation}).height_m;
            for (LayerCount* layer : {&low, &aloft}) {
                if (height < layer->bottom_m || height >= layer->top_m) continue;
                layer->gates += static_cast<std::int64_t>(field.radials);
                for (std::size_t radial = 0; radial < field.radials; ++radial)
                    layer->echo += field.row(radial)[gate] != 0 ? 1 : 0;
            }
        }
    }
    return low.gates > 0 && aloft.gates > 0 && low.share() >= 0.6 && aloft.share() <= 0.2;
}

class KindNamer {
  public:
    KindNamer(const level2::Volume& volume, std::span<const SweepQuality> qualities, double least,
              bool only_single)
        : volume_(volume),
          qualities_(qualities),
          least_(static_cast<float>(least)),
          only_single_(only_single),
          antenna_(level2::antenna_position(volume)) {
        for (const level2::Sweep& sweep : volume.sweeps)
            lowest_deg_ = std::fmin(lowest_deg_, sweep.mean_elevation_deg());
    }

    std::vector<SweepKinds> name() {
        // Begin with the sweeps whose results other sweeps copy.
        for (const SweepQuality& quality : qualities_)
            if (!source_of(quality)) named_.push_back(named(quality));
        const std::size_t count = named_.size();
        for (const SweepQuality& quality : qualities_)
            if (const auto from = source_of(quality)) copy(quality, *from, count);
        std::ranges::stable_sort(named_, {}, &SweepKinds::sweep);
        return std::move(named_);
    }

  private:
    [[nodiscard]] std::optional<std::size_t> source_of(const SweepQuality& quality) const {
        return only_single_ ? std::nullopt : dual_source(volume_, quality.sweep);
    }
    SweepFacts facts_of(std::size_t number) {
        const level2::Sweep& sweep = volume_.sweeps[number];
        SweepFacts facts;
        facts.is_lowest = std::islessequal(sweep.mean_elevation_deg(), lowest_deg_ + 1.2);
        facts.has_sweep_above = sweep_above(volume_, number).has_value();
        facts.has_dual = !only_single_ && has_dual_polarization(sweep);
        if (facts.has_dual) return facts;
        if (!bloom_) bloom_ = has_bloom(volume_, qualities_);
        facts.is_in_bloom = *bloom_;
        return facts;
    }
    [[nodiscard]] std::optional<SunPosition> sun_of(const level2::Sweep& sweep) const {
        if (!antenna_ || sweep.radials.empty()) return std::nullopt;
        const UtcTime middle = sweep.radials[sweep.radials.size() / 2].time;
        if (!level2::is_plausible(middle)) return std::nullopt;
        return sun_position(middle, antenna_->latitude_deg, antenna_->longitude_deg);
    }
    SweepKinds named(const SweepQuality& quality) {
        const level2::Sweep& sweep = volume_.sweeps[quality.sweep];
        const GateField field = gate_field(sweep, sweep.moments[quality.moment]);
        const std::vector<float>& probabilities = quality.probabilities;
        const EchoGates left(field, probabilities, least_);
        const SweepFacts facts = facts_of(quality.sweep);
        const FeatureColumns columns(volume_, quality.sweep, field, left,
                                     facts.has_dual ? QualityRule::dual : QualityRule::single,
                                     scratch_);
        const std::vector<Spoke> spokes = find_spokes(field, sweep, sun_of(sweep));
        SweepKinds made{quality.sweep, quality.moment, {}};
        made.kinds.resize(field.codes.size());
        std::ranges::transform(probabilities, made.kinds.begin(), [](float probability) {
            return std::isnan(probability) ? EchoKind::none : EchoKind::weather;
        });
        for (std::size_t radial = 0, i = 0; radial < field.radials; ++radial)
            for (const std::uint32_t gate : left.of(radial)) {
                const std::size_t at = radial * field.gates + gate;
                const GateFacts of_gate(columns, i++, field.range_m(gate));
                const Spoke spoke = spokes.empty() ? Spoke::none : spokes[at];
                made.kinds[at] = spoke == Spoke::sun            ? EchoKind::sun_spike
                                 : spoke == Spoke::interference ? EchoKind::interference
                                                                : kind_of(of_gate, facts);
            }
        return made;
    }
    void copy(const SweepQuality& quality, std::size_t from, std::size_t count) {
        const auto named = std::span(named_).first(count);
        const auto source = std::ranges::find(named, from, &SweepKinds::sweep);
        if (source == named.end()) return;
        const level2::Sweep& to = volume_.sweeps[quality.sweep];
        const level2::Sweep& there = volume_.sweeps[from];
        const GateField field = gate_field(to, to.moments[quality.moment]);
        named_.push_back({quality.sweep, quality.moment,
                          taken_values(field, to, there.moments[source->moment], there,
                                       source->kinds, EchoKind::none)});
    }

    const level2::Volume& volume_;
    std::span<const SweepQuality> qualities_;
    float least_;
    bool only_single_;
    std::optional<level2::AntennaPosition> antenna_;
    double lowest_deg_ = std::numeric_limits<double>::quiet_NaN();
    std::optional<bool> bloom_;
    std::vector<SweepKinds> named_;
    GateField scratch_;
};

}  // namespace

std::string_view echo_kind_name(EchoKind kind) {
    static constexpr std::array<std::string_view, echo_kind_count> names = {
        "no echo",   "weather",      "ground clutter",    "distant ground",
        "sun spike", "interference", "birds and insects", "other",
    };
    return names[static_cast<std::size_t>(kind)];
}

std::vector<SweepKinds> echo_kinds(const level2::Volume& volume,
                                   std::span<const SweepQuality> qualities, double least,
                                   bool only_single) {
    return KindNamer(volume, qualities, least, only_single).name();
}

double EchoShares::share(EchoKind kind) const {
    const std::int64_t count = of_kind[static_cast<std::size_t>(kind)];
    return gates > 0 ? static_cast<double>(count) / static_cast<double>(gates) : 0;
}

EchoShares echo_shares(std::span<const SweepKinds> sweeps) {
    EchoShares shares;
    for (const SweepKinds& sweep : sweeps)
        for (const EchoKind kind : sweep.kinds) {
            ++shares.of_kind[static_cast<std::size_t>(kind)];
            shares.gates += kind != EchoKind::none ? 1 : 0;
        }
    return shares;
}

}  // namespace stormcellar::retrieve
