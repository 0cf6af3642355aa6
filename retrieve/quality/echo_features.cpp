#include "retrieve/quality/echo_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "retrieve/quality/gate_loops.h"
#include "retrieve/sweeps/nearest_sweep.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr GateBox one_gate{1, 1};
constexpr float missing = std::numeric_limits<float>::quiet_NaN();

// Finds the gates of another field ("there") that correspond to the gates of this field ("here").
// Ranges there are the ranges here times a factor.
class GatesElsewhere {
  public:
    GatesElsewhere(const GateField& here, const GateField& there, double stretch)
        : gates_(here.gates) {
        for (std::size_t gate = 0; gate < gates_.size(); ++gate)
            gates_[gate] = there.gate_at(here.range_m(gate) * stretch);
        // The gates that have a gate there are consecutive.
        const auto has_place = [](std::int32_t gate) { return gate >= 0; };
        const auto first = std::ranges::find_if(gates_, has_place);
        begin_ = static_cast<std::uint32_t>(first - gates_.begin());
        end_ = static_cast<std::uint32_t>(std::find_if_not(first, gates_.end(), has_place) -
                                          gates_.begin());
    }
    // Returns the gates of `here` that have a gate there, and writes the numbers of the gates
    // there.
    std::span<const std::uint32_t> take(std::span<const std::uint32_t> here,
                                        const std::uint32_t* there, std::uint32_t* numbers) const {
        const auto from = std::ranges::lower_bound(here, begin_);
        const auto placed = std::span(from, std::ranges::lower_bound(here, end_));
        for (std::size_t i = 0; i < placed.size(); ++i)
            numbers[i] = there[gates_[placed[i]]];
        return placed;
    }

  private:
    std::vector<std::int32_t> gates_;  // -1 for none
    std::uint32_t begin_ = 0, end_ = 0;
};

// Finds, for each gate, the gate at the same place in another field ("there") that has other
// radials.
class Elsewhere {
  public:
    // `radials` has, for each radial here, the number of its radial there, or -1 for none.
    Elsewhere(const std::vector<std::int32_t>& radials, std::size_t radials_there,
              GatesElsewhere gates)
        : radials_here_(radials_there + 1), gates_(std::move(gates)) {
        for (std::size_t radial = 0; radial < radials.size(); ++radial) {
            const std::int32_t there = radials[radial];
            const std::size_t slot = there >= 0 ? static_cast<std::size_t>(there) : radials_there;
            radials_here_[slot].push_back(static_cast<std::uint32_t>(radial));
        }
    }

    // Returns the radials here that correspond to a radial there.
    [[nodiscard]] std::span<const std::uint32_t> radials_of(std::size_t there) const {
        return radials_here_[there];
    }
    // Returns the radials here that have no radial there.
    [[nodiscard]] std::span<const std::uint32_t> radials_without() const {
        return radials_here_.back();
    }
    [[nodiscard]] const GatesElsewhere& gates() const { return gates_; }

  private:
    std::vector<std::vector<std::uint32_t>> radials_here_;
    GatesElsewhere gates_;
};

// These functions say how a sum becomes a feature.
SumFeature mean(const GateField& field) {
    return {SumFeature::Kind::mean, field.scale, field.offset};
}
SumFeature magnitude(const GateField& field) {
    return {SumFeature::Kind::magnitude, field.scale, field.offset};
}
SumFeature root_mean(const GateField& field) {
    return {SumFeature::Kind::root_mean, field.scale};
}
SumFeature share(const GateBox& box) {
    return {SumFeature::Kind::share, 1, 0, static_cast<float>(box.size())};
}

class FeatureMaker {
  public:
    FeatureMaker(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                 const EchoGates& echo, GateField& scratch, const FeatureVisitor& visit)
        : volume_(volume),
          sweep_(volume.sweeps[sweep]),
          sweep_number_(sweep),
          field_(field),
          echo_(echo),
          other_(scratch),
          visit_(visit),
          values_(field.gates),
          sums_(field.gates) {}

    void visit_dual() {
        BoxSums codes = BoxSums::of_codes(field_, one_gate);
        for (std::size_t radial = 0; radial < field_.radials; ++radial)
            visit_own(Feature::reflectivity, radial, codes.next(), mean(field_));
        visit_correlation();
        visit_own_texture(Moment::zdr, Feature::zdr_texture);
        visit_own_texture(Moment::phi, Feature::phase_texture);
    }

    void visit_single() {
        const GateBox box = texture_box(field_), wide = wide_box();
        BoxSums codes = BoxSums::of_codes(field_, one_gate);
        BoxSums along = BoxSums::of_differences(field_, box, Direction::range);
        BoxSums across = BoxSums::of_differences(field_, box, Direction::azimuth);
        BoxSums about = BoxSums::of_codes(field_, wide);
        const std::vector<float> heights = heights_m();
        // Visit all features of a radial together, while its numbers are in the processor's cache.
        for (std::size_t radial = 0; radial < field_.radials; ++radial) {
            visit_own(Feature::reflectivity, radial, codes.next(), mean(field_));
            visit_height(radial, heights);
            visit_own(Feature::range_texture, radial, along.next(), root_mean(field_));
            visit_own(Feature::azimuth_texture, radial, across.next(), root_mean(field_));
            const std::uint32_t* sums = about.next();
            visit_own(Feature::mean_reflectivity, radial, sums, mean(field_));
            visit_own(Feature::echo_share, radial, sums, share(wide));
        }
        visit_above();
        visit_doppler();
    }

    void visit_for_kinds(QualityRule rule) {
        const GateBox wide = wide_box();
        BoxSums codes = BoxSums::of_codes(field_, one_gate);
        BoxSums along = BoxSums::of_differences(field_, texture_box(field_), Direction::range);
        BoxSums about = BoxSums::of_codes(field_, wide);
        const std::vector<float> heights = heights_m();
        for (std::size_t radial = 0; radial < field_.radials; ++radial) {
            visit_own(Feature::reflectivity, radial, codes.next(), mean(field_));
            visit_height(radial, heights);
            visit_own(Feature::range_texture, radial, along.next(), root_mean(field_));
            visit_own(Feature::echo_share, radial, about.next(), share(wide));
        }
        visit_above();
        visit_doppler();
        if (rule == QualityRule::single) return;
        visit_correlation();
        visit_own_texture(Moment::phi, Feature::phase_texture);
    }

  private:
    [[nodiscard]] GateBox wide_box() const { return gate_box(9, 8250, field_); }
    [[nodiscard]] static GateBox texture_box(const GateField& field) {
        return gate_box(3, 1750, field);
    }
    // Calls the visitor with the first of values_.
    void visit_values(Feature feature, std::size_t radial) {
        visit_(feature, radial, std::span(values_).first(echo_.of(radial).size()));
    }
    // Calls the visitor with the results of `value` for the gates with echo of a radial.
    template <class Value>
    void visit_radial(Feature feature, std::size_t radial, Value value) {
        const auto gates = echo_.of(radial);
        for (std::size_t i = 0; i < gates.size(); ++i)
            values_[i] = value(gates[i]);
        visit_values(feature, radial);
    }
    void visit_missing(Feature feature, std::size_t radial) {
        visit_radial(feature, radial, [](std::uint32_t) { return missing; });
    }
    void visit_missing(Feature feature) {
        for (std::size_t radial = 0; radial < field_.radials; ++radial)
            visit_missing(feature, radial);
    }
    [[nodiscard]] std::vector<float> heights_m() const {
        // The latitude hardly matters: it changes heights by less than 0.2 %.
        const grid::BeamGeometry beam(40, 0);
        const double elevation = sweep_.mean_elevation_deg();
        std::vector<float> heights(field_.gates);
        for (std::size_t gate = 0; gate < heights.size(); ++gate)
            heights[gate] =
                static_cast<float>(beam.forward({field_.range_m(gate), elevation}).height_m);
        return heights;
    }
    void visit_height(std::size_t radial, const std::vector<float>& heights) {
        visit_radial(Feature::height, radial, [&](std::uint32_t gate) { return heights[gate]; });
    }
    void visit_own(Feature feature, std::size_t radial, const std::uint32_t* sums,
                   const SumFeature& how) {
        const auto gates = echo_.of(radial);
        for (std::size_t i = 0; i < gates.size(); ++i)
            sums_[i] = sums[gates[i]];
        features_of_sums(sums_.data(), gates.size(), how, values_.data());
        visit_values(feature, radial);
    }

    // Another moment of the same sweep has the same radials, and may have other gates.
    void visit_correlation() {
        if (!read_other(sweep_, Moment::rho)) return visit_missing(Feature::correlation);
        visit_other(Feature::correlation, BoxSums::of_codes(other_, gate_box(3, 1250, other_)),
                    mean(other_));
    }
    void visit_own_texture(Moment kind, Feature feature) {
        if (!read_other(sweep_, kind)) return visit_missing(feature);
        const float turn = kind == Moment::phi ? 360 : 0;
        visit_other(
            feature,
            BoxSums::of_differences(other_, gate_box(3, 2250, other_), Direction::range, turn),
            root_mean(other_));
    }
    void visit_other(Feature feature, BoxSums sums, const SumFeature& how) {
        const GatesElsewhere gates(field_, other_, 1);
        for (std::size_t radial = 0; radial < field_.radials; ++radial)
            visit_sums(feature, radial, gates, sums.next(), how);
    }
    // Reads another moment. Returns false if the sweep lacks it, or if it has no gates.
    bool read_other(const level2::Sweep& sweep, Moment kind) {
        const level2::SweepMoment* moment = sweep.find(kind);
        if (moment == nullptr) return false;
        read_gate_field(sweep, *moment, other_);
        return !other_.is_empty();
    }
    // Visits a radial whose feature comes from the sums of another field.
    void visit_sums(Feature feature, std::size_t radial, const GatesElsewhere& gates,
                    const std::uint32_t* sums, const SumFeature& how) {
        const auto here = echo_.of(radial);
        const auto placed = gates.take(here, sums, sums_.data());
        float* values = values_.data() + (placed.data() - here.data());
        std::fill(values_.data(), values, missing);
        features_of_sums(sums_.data(), placed.size(), how, values);
        std::fill(values + placed.size(), values_.data() + here.size(), missing);
        visit_values(feature, radial);
    }

    // The sums of another sweep, and the feature that comes from them.
    struct SumsThere {
        Feature feature;
        BoxSums sums;
        SumFeature how;
    };
    // Visits all radials with features from the sums of other_, a field of another sweep.
    void visit_there(const Elsewhere& place, std::span<SumsThere> all) {
        for (std::size_t there = 0; there < other_.radials; ++there)
            for (SumsThere& one : all) {
                const std::uint32_t* sums = one.sums.next();
                for (const std::uint32_t radial : place.radials_of(there))
                    visit_sums(one.feature, radial, place.gates(), sums, one.how);
            }
        for (const std::uint32_t radial : place.radials_without())
            for (const SumsThere& one : all)
                visit_missing(one.feature, radial);
    }
    void visit_above() {
        const auto above = sweep_above(volume_, sweep_number_);
        if (!above) return visit_missing(Feature::reflectivity_above);
        const level2::Sweep& sweep = volume_.sweeps[*above];
        if (!read_other(sweep, Moment::ref)) return visit_missing(Feature::reflectivity_above);
        // In the sweep above, the same place on the ground is at a longer range.
        constexpr double radian = std::numbers::pi / 180;
        const double stretch = std::cos(sweep_.mean_elevation_deg() * radian) /
                               std::cos(sweep.mean_elevation_deg() * radian);
        const Elsewhere place(nearest_radials(azimuths_of(sweep_), sweep), other_.radials,
                              GatesElsewhere(field_, other_, stretch));
        std::array all = {SumsThere{Feature::reflectivity_above,
                                    BoxSums::of_codes(other_, gate_box(3, 1250, other_)),
                                    mean(other_)}};
        visit_there(place, all);
    }
    void visit_doppler() {
        const auto companion =
            companion_sweep(volume_, sweep_number_, sweep_.mean_elevation_deg(), Moment::vel);
        if (!companion || !read_other(volume_.sweeps[*companion], Moment::vel)) {
            for (const Feature feature :
                 {Feature::speed, Feature::speed_texture, Feature::speed_share, Feature::width})
                visit_missing(feature);
            return;
        }
        const level2::Sweep& sweep = volume_.sweeps[*companion];
        const auto radials = nearest_radials(azimuths_of(sweep_), sweep);
        const Elsewhere place(radials, other_.radials, GatesElsewhere(field_, other_, 1));
        const GateBox box = texture_box(other_);
        std::array all = {
            SumsThere{Feature::speed, BoxSums::of_codes(other_, one_gate), magnitude(other_)},
            SumsThere{Feature::speed_texture,
                      BoxSums::of_differences(other_, box, Direction::range,
                                              2 * sweep.radials.front().nyquist_mps),
                      root_mean(other_)},
            SumsThere{Feature::speed_share, BoxSums::of_codes(other_, box), share(box)}};
        visit_there(place, all);
        visit_width(sweep, radials);
    }
    void visit_width(const level2::Sweep& sweep, const std::vector<std::int32_t>& radials) {
        if (!read_other(sweep, Moment::sw)) return visit_missing(Feature::width);
        const Elsewhere place(radials, other_.radials, GatesElsewhere(field_, other_, 1));
        std::array all = {SumsThere{Feature::width, BoxSums::of_codes(other_, texture_box(other_)),
                                    mean(other_)}};
        visit_there(place, all);
    }

    const level2::Volume& volume_;
    const level2::Sweep& sweep_;
    std::size_t sweep_number_;
    const GateField& field_;
    const EchoGates& echo_;
    GateField& other_;  // another moment, of this sweep or another sweep
    const FeatureVisitor& visit_;
    // These hold the gates with echo of one radial.
    std::vector<float> values_;
    std::vector<std::uint32_t> sums_;
};

}  // namespace

std::string_view feature_name(Feature feature) {
    static constexpr std::array<std::string_view, feature_count> names = {
        "reflectivity",       "height",
        "range_texture",      "azimuth_texture",
        "echo_share",         "mean_reflectivity",
        "reflectivity_above", "speed",
        "speed_texture",      "width",
        "speed_share",        "correlation",
        "zdr_texture",        "phase_texture",
    };
    return names[static_cast<std::size_t>(feature)];
}

EchoGates::EchoGates(const GateField& field) : begins_(field.radials + 1, 0) {
    take(field, [&](std::size_t at) { return field.codes[at] != 0; });
}

EchoGates::EchoGates(const GateField& field, std::span<const float> probabilities, float least)
    : begins_(field.radials + 1, 0) {
    take(field, [&](std::size_t at) {
        return field.codes[at] != 0 && std::isless(probabilities[at], least);
    });
}

template <class IsTaken>
void EchoGates::take(const GateField& field, IsTaken is_taken) {
    gates_.resize(std::reduce(field.ends.begin(), field.ends.end()));
    for (std::size_t radial = 0; radial < field.radials; ++radial) {
        const std::size_t end = field.ends[radial];
        std::size_t count = begins_[radial];
        // Branches on echo are hard to predict, so write every gate, but count only the gates that
        // are taken.
        for (std::size_t gate = 0; gate < end; ++gate) {
            gates_[count] = static_cast<std::uint32_t>(gate);
            count += is_taken(radial * field.gates + gate) ? 1 : 0;
        }
        begins_[radial + 1] = count;
    }
    gates_.resize(begins_.back());
}

void visit_features(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                    const EchoGates& echo, QualityRule rule, GateField& scratch,
                    const FeatureVisitor& visit) {
    FeatureMaker maker(volume, sweep, field, echo, scratch, visit);
    if (rule == QualityRule::dual)
        maker.visit_dual();
    else
        maker.visit_single();
}

void visit_kind_features(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                         const EchoGates& echo, QualityRule rule, GateField& scratch,
                         const FeatureVisitor& visit) {
    FeatureMaker(volume, sweep, field, echo, scratch, visit).visit_for_kinds(rule);
}

}  // namespace stormcellar::retrieve
