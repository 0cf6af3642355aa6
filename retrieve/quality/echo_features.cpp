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

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

// The gates of another field that have the ranges of the gates here, times a factor.
class GatesElsewhere {
  public:
    GatesElsewhere(const GateField& here, const GateField& there, double stretch)
        : gates_(here.gates) {
        for (std::size_t gate = 0; gate < gates_.size(); ++gate)
            gates_[gate] = there.gate_at(here.range_m(gate) * stretch);
        // The gates that have a place there follow each other.
        const auto has_place = [](std::int32_t gate) { return gate >= 0; };
        const auto first = std::ranges::find_if(gates_, has_place);
        begin_ = static_cast<std::uint32_t>(first - gates_.begin());
        end_ = static_cast<std::uint32_t>(std::find_if_not(first, gates_.end(), has_place) -
                                          gates_.begin());
    }
    // Writes the numbers there of the gates here that have a place, and returns which these are.
    template <class Number>
    std::span<const std::uint32_t> take(std::span<const std::uint32_t> here, const Number* there,
                                        std::vector<Number>& numbers) const {
        const auto from = std::ranges::lower_bound(here, begin_);
        const auto placed = std::span(from, std::ranges::lower_bound(here, end_));
        numbers.resize(placed.size());
        for (std::size_t i = 0; i < placed.size(); ++i)
            numbers[i] = there[gates_[placed[i]]];
        return placed;
    }

  private:
    std::vector<std::int32_t> gates_;  // -1 for none
    std::uint32_t begin_ = 0, end_ = 0;
};

// The place of each gate in another field with other radials.
class Elsewhere {
  public:
    // `radials` are the numbers there, or -1 for none.
    Elsewhere(const std::vector<std::int32_t>& radials, std::size_t radials_there,
              GatesElsewhere gates)
        : radials_here_(radials_there + 1), gates_(std::move(gates)) {
        for (std::size_t radial = 0; radial < radials.size(); ++radial) {
            const std::int32_t there = radials[radial];
            const std::size_t slot = there >= 0 ? static_cast<std::size_t>(there) : radials_there;
            radials_here_[slot].push_back(static_cast<std::uint32_t>(radial));
        }
    }

    // Returns the radials here whose place is a radial there.
    [[nodiscard]] std::span<const std::uint32_t> radials_of(std::size_t there) const {
        return radials_here_[there];
    }
    // Returns the radials here that have no place there.
    [[nodiscard]] std::span<const std::uint32_t> radials_without() const {
        return radials_here_.back();
    }
    [[nodiscard]] const GatesElsewhere& gates() const { return gates_; }

  private:
    std::vector<std::vector<std::uint32_t>> radials_here_;
    GatesElsewhere gates_;
};

// The three ways from a sum to a feature.
SumFeature mean(const GateField& field) {
    return {SumFeature::Kind::mean, field.scale, field.offset};
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
          visit_(visit) {}

    void visit_dual() {
        visit_reflectivity();
        visit_correlation();
        visit_own_sums(Moment::zdr, Feature::zdr_texture, 2250, &FeatureMaker::sum_differences);
        visit_phase_texture();
    }

    void visit_single() {
        visit_reflectivity();
        visit_height();
        visit_texture(Direction::range, Feature::range_texture);
        visit_texture(Direction::azimuth, Feature::azimuth_texture);
        const GateBox wide = wide_box();
        const SumVisitor to_mean = at_own_gates(Feature::mean_reflectivity, mean(field_));
        const SumVisitor to_share = at_own_gates(Feature::echo_share, share(wide));
        visit_code_sums(field_, wide, [&](std::size_t radial, const std::uint32_t* sums) {
            to_mean(radial, sums);
            to_share(radial, sums);
        });
        visit_above();
        visit_doppler();
    }

    void visit_for_kinds(QualityRule rule) {
        visit_reflectivity();
        visit_height();
        visit_texture(Direction::range, Feature::range_texture);
        const GateBox wide = wide_box();
        visit_code_sums(field_, wide, at_own_gates(Feature::echo_share, share(wide)));
        visit_above();
        visit_doppler();
        if (rule == QualityRule::single) return;
        visit_correlation();
        visit_phase_texture();
    }

  private:
    [[nodiscard]] GateBox wide_box() const { return gate_box(9, 8250, field_); }
    void visit_texture(Direction direction, Feature feature) {
        visit_difference_sums(field_, gate_box(3, 1750, field_), direction, 0,
                              at_own_gates(feature, root_mean(field_)));
    }
    void visit_correlation() {
        visit_own_sums(Moment::rho, Feature::correlation, 1250, &FeatureMaker::sum_codes);
    }
    void visit_phase_texture() {
        visit_own_sums(Moment::phi, Feature::phase_texture, 2250, &FeatureMaker::sum_differences);
    }
    // Calls the visitor with what `value` gives for each gate with echo of a radial.
    template <class Value>
    void visit_radial(Feature feature, std::size_t radial, Value value) {
        const auto gates = echo_.of(radial);
        values_.resize(gates.size());
        for (std::size_t i = 0; i < gates.size(); ++i)
            values_[i] = value(gates[i]);
        visit_(feature, radial, values_);
    }
    template <class Value>
    void visit_all(Feature feature, Value value) {
        for (std::size_t radial = 0; radial < field_.radials; ++radial)
            visit_radial(feature, radial, [&](std::uint32_t gate) { return value(radial, gate); });
    }
    void visit_missing(Feature feature) {
        visit_all(feature, [](std::size_t, std::uint32_t) { return missing; });
    }
    void visit_reflectivity() {
        visit_all(Feature::reflectivity, [&](std::size_t radial, std::uint32_t gate) {
            return field_.value(radial, gate);
        });
    }
    void visit_height() {
        // The latitude hardly matters: it changes heights by less than 0.2 %.
        const grid::BeamGeometry beam(40, 0);
        const double elevation = sweep_.mean_elevation_deg();
        std::vector<float> heights(field_.gates);
        for (std::size_t gate = 0; gate < heights.size(); ++gate)
            heights[gate] =
                static_cast<float>(beam.forward({field_.range_m(gate), elevation}).height_m);
        visit_all(Feature::height, [&](std::size_t, std::uint32_t gate) { return heights[gate]; });
    }
    SumVisitor at_own_gates(Feature feature, const SumFeature& how) {
        return [this, feature, how](std::size_t radial, const std::uint32_t* sums) {
            const auto gates = echo_.of(radial);
            sums_.resize(gates.size());
            values_.resize(gates.size());
            for (std::size_t i = 0; i < gates.size(); ++i)
                sums_[i] = sums[gates[i]];
            features_of_sums(sums_.data(), gates.size(), how, values_.data());
            visit_(feature, radial, values_);
        };
    }

    // Another moment of the same sweep has the same radials, and may have other gates.
    using SumUp = void (FeatureMaker::*)(Feature, const GateBox&);
    void visit_own_sums(Moment kind, Feature feature, double length_m, SumUp sum_up) {
        if (!read_other(sweep_, kind)) return visit_missing(feature);
        (this->*sum_up)(feature, gate_box(3, length_m, other_));
    }
    // Reads another moment. Returns false if the sweep lacks it, or if it has no gates.
    bool read_other(const level2::Sweep& sweep, Moment kind) {
        const level2::SweepMoment* moment = sweep.find(kind);
        if (moment == nullptr) return false;
        read_gate_field(sweep, *moment, other_);
        return !other_.is_empty();
    }
    void sum_codes(Feature feature, const GateBox& box) {
        visit_code_sums(other_, box, at_gates_of_other(feature, mean(other_)));
    }
    void sum_differences(Feature feature, const GateBox& box) {
        const float turn = feature == Feature::phase_texture ? 360 : 0;
        visit_difference_sums(other_, box, Direction::range, turn,
                              at_gates_of_other(feature, root_mean(other_)));
    }
    SumVisitor at_gates_of_other(Feature feature, const SumFeature& how) {
        return [this, feature, how, gates = GatesElsewhere(field_, other_, 1)](
                   std::size_t radial, const std::uint32_t* sums) {
            visit_sums(feature, radial, gates, sums, how);
        };
    }
    // Visits a radial whose sums are those of other gates.
    void visit_sums(Feature feature, std::size_t radial, const GatesElsewhere& gates,
                    const std::uint32_t* sums, const SumFeature& how) {
        visit_placed(feature, radial, gates, sums, sums_, [&](float* values) {
            features_of_sums(sums_.data(), sums_.size(), how, values);
        });
    }
    // Visits a radial: `write` writes the values of the numbers taken at other gates.
    template <class Number, class Write>
    void visit_placed(Feature feature, std::size_t radial, const GatesElsewhere& gates,
                      const Number* there, std::vector<Number>& numbers, Write write) {
        const auto here = echo_.of(radial);
        const auto placed = gates.take(here, there, numbers);
        const auto before = static_cast<std::size_t>(placed.data() - here.data());
        values_.resize(here.size());
        std::fill_n(values_.begin(), before, missing);
        std::fill(values_.begin() + static_cast<std::ptrdiff_t>(before + placed.size()),
                  values_.end(), missing);
        write(values_.data() + before);
        visit_(feature, radial, values_);
    }

    void visit_without_place(Feature feature, const Elsewhere& place) {
        for (const std::uint32_t radial : place.radials_without())
            visit_radial(feature, radial, [](std::uint32_t) { return missing; });
    }
    // Gets the sums of another sweep.
    SumVisitor at_place(Feature feature, const Elsewhere& place, const SumFeature& how) {
        visit_without_place(feature, place);
        return [this, feature, &place, how](std::size_t there, const std::uint32_t* sums) {
            for (const std::uint32_t radial : place.radials_of(there))
                visit_sums(feature, radial, place.gates(), sums, how);
        };
    }
    void visit_above() {
        const auto above = sweep_above(volume_, sweep_number_);
        if (!above) return visit_missing(Feature::reflectivity_above);
        const level2::Sweep& sweep = volume_.sweeps[*above];
        if (!read_other(sweep, Moment::ref)) return visit_missing(Feature::reflectivity_above);
        // The same place on the ground is at a longer range there.
        constexpr double radian = std::numbers::pi / 180;
        const double stretch = std::cos(sweep_.mean_elevation_deg() * radian) /
                               std::cos(sweep.mean_elevation_deg() * radian);
        const Elsewhere place(nearest_radials(azimuths_of(sweep_), sweep), other_.radials,
                              GatesElsewhere(field_, other_, stretch));
        visit_code_sums(other_, gate_box(3, 1250, other_),
                        at_place(Feature::reflectivity_above, place, mean(other_)));
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
        visit_speed(place);
        const GateBox box = gate_box(3, 1750, other_);
        visit_difference_sums(other_, box, Direction::range, 2 * sweep.radials.front().nyquist_mps,
                              at_place(Feature::speed_texture, place, root_mean(other_)));
        visit_code_sums(other_, box, at_place(Feature::speed_share, place, share(box)));
        visit_width(sweep, radials);
    }
    void visit_speed(const Elsewhere& place) {
        visit_without_place(Feature::speed, place);
        for (std::size_t there = 0; there < other_.radials; ++there)
            for (const std::uint32_t radial : place.radials_of(there))
                visit_placed(Feature::speed, radial, place.gates(), other_.row(there), codes_,
                             [&](float* speeds) {
                                 for (std::size_t i = 0; i < codes_.size(); ++i)
                                     speeds[i] = codes_[i] != 0
                                                     ? std::abs(other_.value_of(codes_[i]))
                                                     : missing;
                             });
    }
    void visit_width(const level2::Sweep& sweep, const std::vector<std::int32_t>& radials) {
        if (!read_other(sweep, Moment::sw)) return visit_missing(Feature::width);
        const Elsewhere place(radials, other_.radials, GatesElsewhere(field_, other_, 1));
        visit_code_sums(other_, gate_box(3, 1750, other_),
                        at_place(Feature::width, place, mean(other_)));
    }

    const level2::Volume& volume_;
    const level2::Sweep& sweep_;
    std::size_t sweep_number_;
    const GateField& field_;
    const EchoGates& echo_;
    GateField& other_;  // another moment, of this sweep or another one
    const FeatureVisitor& visit_;
    // Of one radial, to reuse their memory.
    std::vector<float> values_;
    std::vector<std::uint32_t> sums_;
    std::vector<std::uint16_t> codes_;
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
        // Branches on echo are hard to predict, so write each gate and count those that are taken.
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
