#include "retrieve/quality/echo_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "retrieve/sweeps/nearest_sweep.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

// The place of each gate in another field with other radials.
class Elsewhere {
  public:
    // `radials` and `gates` are the numbers there, or -1 for none.
    Elsewhere(const std::vector<std::int32_t>& radials, std::size_t radials_there,
              std::vector<std::int32_t> gates)
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
    [[nodiscard]] std::int32_t gate(std::uint32_t here) const { return gates_[here]; }

  private:
    std::vector<std::vector<std::uint32_t>> radials_here_;
    std::vector<std::int32_t> gates_;
};

std::vector<std::int32_t> gates_elsewhere(const GateField& here, const GateField& there,
                                          double stretch) {
    std::vector<std::int32_t> gates(here.gates);
    for (std::size_t gate = 0; gate < gates.size(); ++gate)
        gates[gate] = there.gate_at(here.range_m(gate) * stretch);
    return gates;
}

// The three ways from a sum to a feature.
auto mean(const GateField& field) {
    return [&field](BoxSum sum) { return field.value_of(sum.mean()); };
}
auto root_mean(const GateField& field) {
    return [scale = field.scale](BoxSum sum) { return std::sqrt(sum.mean()) / scale; };
}
auto share(const GateBox& box) {
    return [all = static_cast<float>(box.size())](BoxSum sum) { return sum.count() / all; };
}

class FeatureMaker {
  public:
    FeatureMaker(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                 const EchoGates& echo, const FeatureVisitor& visit)
        : volume_(volume),
          sweep_(volume.sweeps[sweep]),
          sweep_number_(sweep),
          field_(field),
          echo_(echo),
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
    template <class Value>
    SumVisitor at_own_gates(Feature feature, Value value) {
        return [this, feature, value](std::size_t radial, const std::uint32_t* sums) {
            visit_radial(feature, radial,
                         [&](std::uint32_t gate) { return value(BoxSum(sums[gate])); });
        };
    }

    // Another moment of the same sweep has the same radials, and may have other gates.
    using SumUp = void (FeatureMaker::*)(Feature, const GateField&, const GateBox&);
    void visit_own_sums(Moment kind, Feature feature, double length_m, SumUp sum_up) {
        const level2::SweepMoment* moment = sweep_.find(kind);
        const GateField other = moment != nullptr ? gate_field(sweep_, *moment) : GateField{};
        if (other.is_empty()) return visit_missing(feature);
        (this->*sum_up)(feature, other, gate_box(3, length_m, other));
    }
    void sum_codes(Feature feature, const GateField& other, const GateBox& box) {
        visit_code_sums(other, box, at_gates_of(feature, other, mean(other)));
    }
    void sum_differences(Feature feature, const GateField& other, const GateBox& box) {
        const float turn = feature == Feature::phase_texture ? 360 : 0;
        visit_difference_sums(other, box, Direction::range, turn,
                              at_gates_of(feature, other, root_mean(other)));
    }
    template <class Value>
    SumVisitor at_gates_of(Feature feature, const GateField& other, Value value) {
        return [this, feature, value, gates = gates_elsewhere(field_, other, 1)](
                   std::size_t radial, const std::uint32_t* sums) {
            visit_radial(feature, radial, [&](std::uint32_t gate) {
                return gates[gate] >= 0 ? value(BoxSum(sums[gates[gate]])) : missing;
            });
        };
    }

    // Visits the gates here whose radial is the given one elsewhere, where `numbers` are.
    template <class Number, class Value>
    void visit_from(Feature feature, const Elsewhere& place, std::size_t there,
                    const Number* numbers, Value value) {
        for (const std::uint32_t radial : place.radials_of(there))
            visit_radial(feature, radial, [&](std::uint32_t gate) {
                const std::int32_t at = place.gate(gate);
                return at >= 0 ? value(numbers[at]) : missing;
            });
    }
    void visit_without_place(Feature feature, const Elsewhere& place) {
        for (const std::uint32_t radial : place.radials_without())
            visit_radial(feature, radial, [](std::uint32_t) { return missing; });
    }
    // Gets the sums of another sweep.
    template <class Value>
    SumVisitor at_place(Feature feature, const Elsewhere& place, Value value) {
        visit_without_place(feature, place);
        return [this, feature, &place, value](std::size_t there, const std::uint32_t* sums) {
            visit_from(feature, place, there, sums,
                       [&](std::uint32_t bits) { return value(BoxSum(bits)); });
        };
    }
    void visit_above() {
        const auto above = sweep_above(volume_, sweep_number_);
        if (!above) return visit_missing(Feature::reflectivity_above);
        const level2::Sweep& sweep = volume_.sweeps[*above];
        const GateField field = gate_field(sweep, *sweep.find(Moment::ref));
        if (field.is_empty()) return visit_missing(Feature::reflectivity_above);
        // The same place on the ground is at a longer range there.
        constexpr double radian = std::numbers::pi / 180;
        const double stretch = std::cos(sweep_.mean_elevation_deg() * radian) /
                               std::cos(sweep.mean_elevation_deg() * radian);
        const Elsewhere place(nearest_radials(azimuths_of(sweep_), sweep), field.radials,
                              gates_elsewhere(field_, field, stretch));
        visit_code_sums(field, gate_box(3, 1250, field),
                        at_place(Feature::reflectivity_above, place, mean(field)));
    }
    void visit_doppler() {
        const auto companion =
            companion_sweep(volume_, sweep_number_, sweep_.mean_elevation_deg(), Moment::vel);
        const level2::Sweep* sweep = companion ? &volume_.sweeps[*companion] : nullptr;
        const GateField velocity =
            sweep != nullptr ? gate_field(*sweep, *sweep->find(Moment::vel)) : GateField{};
        if (velocity.is_empty()) {
            for (const Feature feature :
                 {Feature::speed, Feature::speed_texture, Feature::speed_share, Feature::width})
                visit_missing(feature);
            return;
        }
        const auto radials = nearest_radials(azimuths_of(sweep_), *sweep);
        const Elsewhere place(radials, velocity.radials, gates_elsewhere(field_, velocity, 1));
        visit_without_place(Feature::speed, place);
        for (std::size_t there = 0; there < velocity.radials; ++there)
            visit_from(Feature::speed, place, there, velocity.row(there), [&](std::uint16_t code) {
                return code != 0 ? std::abs(velocity.value_of(code)) : missing;
            });
        const GateBox box = gate_box(3, 1750, velocity);
        visit_difference_sums(velocity, box, Direction::range,
                              2 * sweep->radials.front().nyquist_mps,
                              at_place(Feature::speed_texture, place, root_mean(velocity)));
        visit_code_sums(velocity, box, at_place(Feature::speed_share, place, share(box)));
        visit_width(*sweep, radials);
    }
    void visit_width(const level2::Sweep& sweep, const std::vector<std::int32_t>& radials) {
        const level2::SweepMoment* moment = sweep.find(Moment::sw);
        const GateField width = moment != nullptr ? gate_field(sweep, *moment) : GateField{};
        if (width.is_empty()) return visit_missing(Feature::width);
        const Elsewhere place(radials, width.radials, gates_elsewhere(field_, width, 1));
        visit_code_sums(width, gate_box(3, 1750, width),
                        at_place(Feature::width, place, mean(width)));
    }

    const level2::Volume& volume_;
    const level2::Sweep& sweep_;
    std::size_t sweep_number_;
    const GateField& field_;
    const EchoGates& echo_;
    const FeatureVisitor& visit_;
    std::vector<float> values_;
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
    for (std::size_t radial = 0; radial < field.radials; ++radial) {
        const std::size_t end = field.end_of_values(radial);
        std::size_t count = begins_[radial];
        gates_.resize(std::max(gates_.size(), count + end));
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
                    const EchoGates& echo, QualityRule rule, const FeatureVisitor& visit) {
    FeatureMaker maker(volume, sweep, field, echo, visit);
    if (rule == QualityRule::dual)
        maker.visit_dual();
    else
        maker.visit_single();
}

void visit_kind_features(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                         const EchoGates& echo, QualityRule rule, const FeatureVisitor& visit) {
    FeatureMaker(volume, sweep, field, echo, visit).visit_for_kinds(rule);
}

}  // namespace stormcellar::retrieve
