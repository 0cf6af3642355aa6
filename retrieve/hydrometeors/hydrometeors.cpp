// Classifies each gate by means, standard deviations and its height.
#include "stormcellar/retrieve/hydrometeors.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "retrieve/hydrometeors/memberships.h"
#include "retrieve/quality/dual_source.h"
#include "retrieve/quality/echo_features.h"
#include "retrieve/quality/gate_field.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/retrieve/kdp.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;

constexpr double half_beam_deg = 0.95 / 2, mean_length_m = 1250;
constexpr double assumed_depth_m = 500;
constexpr std::string_view class_zero_c_words = ", with 0 C at ";
constexpr float least_kdp_deg_per_km = 0.001F;  // 10 lg of it is -30

// Collects the variables of all gates with echo of a sweep.
class VariablesOfSweep {
  public:
    VariablesOfSweep(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                     const EchoGates& echo, const SweepKdp* kdp)
        : sweep_(volume.sweeps[sweep]), field_(field), echo_(echo), gates_(echo.count()) {
        take_means(field, &GateVariables::reflectivity_dbz);
        take_means(field_of_moment(Moment::zdr), &GateVariables::zdr_db);
        GateField scratch;
        visit_kind_features(volume, sweep, field, echo, QualityRule::dual, scratch,
                            [&](Feature feature, std::size_t radial, std::span<const float> of) {
                                take_feature(feature, echo_.begin(radial), of);
                            });
        if (kdp != nullptr) take_kdp(*kdp);
    }
    [[nodiscard]] const GateVariables& operator[](std::size_t i) const { return gates_[i]; }

  private:
    [[nodiscard]] GateField field_of_moment(Moment kind) const {
        const level2::SweepMoment* moment = sweep_.find(kind);
        return moment != nullptr ? gate_field(sweep_, *moment) : GateField{};
    }
    // For each gate with echo that has a place, calls visit(index of the gate among the gates with
    // echo, place).
    template <class Visit>
    void visit_radial(std::size_t radial, const std::vector<std::int32_t>& places, Visit visit) {
        std::size_t i = echo_.begin(radial);
        for (const std::uint32_t gate : echo_.of(radial)) {
            if (places[gate] >= 0) visit(i, static_cast<std::size_t>(places[gate]));
            ++i;
        }
    }
    [[nodiscard]] std::vector<std::int32_t> places_in(const GateField& other) const {
        std::vector<std::int32_t> places(field_.gates);
        for (std::size_t gate = 0; gate < places.size(); ++gate)
            places[gate] = other.gate_at(field_.range_m(gate));
        return places;
    }
    void take_means(const GateField& other, float GateVariables::*to) {
        if (other.is_empty()) return;
        const auto places = places_in(other);
        BoxSums all_sums = BoxSums::of_codes(other, gate_box(3, mean_length_m, other));
        for (std::size_t radial = 0; radial < other.radials; ++radial) {
            const std::uint32_t* const sums = all_sums.next();
            visit_radial(radial, places, [&](std::size_t i, std::size_t place) {
                gates_[i].*to = other.value_of(BoxSum(sums[place]).mean());
            });
        }
    }
    void take_feature(Feature feature, std::size_t first, std::span<const float> values) {
        constexpr float per_difference = 1 / std::numbers::sqrt2_v<float>;
        const auto take = [&](float GateVariables::*to, float factor) {
            for (std::size_t i = 0; i < values.size(); ++i)
                gates_[first + i].*to = values[i] * factor;
        };
        if (feature == Feature::correlation) take(&GateVariables::correlation, 1);
        if (feature == Feature::speed) take(&GateVariables::speed_mps, 1);
        if (feature == Feature::range_texture)
            take(&GateVariables::reflectivity_deviation_db, per_difference);
        if (feature == Feature::phase_texture)
            take(&GateVariables::phase_deviation_deg, per_difference);
    }
    void take_kdp(const SweepKdp& kdp) {
        const GateField phases = gate_field(sweep_, sweep_.moments[kdp.moment]);
        const auto places = places_in(phases);
        for (std::size_t radial = 0; radial < field_.radials; ++radial)
            visit_radial(radial, places, [&](std::size_t i, std::size_t place) {
                const float value = kdp.deg_per_km[radial * phases.gates + place];
                if (std::isnan(value)) return;
                gates_[i].log_kdp = 10 * std::log10(std::max(value, least_kdp_deg_per_km));
            });
    }

    const level2::Sweep& sweep_;
    const GateField& field_;
    const EchoGates& echo_;
    std::vector<GateVariables> gates_;
};

BeamPlace place_of(const LayerHeights& layer, double lower_m, double center_m, double upper_m) {
    if (upper_m < layer.bottom_m) return BeamPlace::below;
    if (center_m < layer.bottom_m) return BeamPlace::center_below;
    if (center_m <= layer.top_m) return BeamPlace::inside;
    return lower_m <= layer.top_m ? BeamPlace::center_above : BeamPlace::above;
}

// Returns the place of the beam at each gate of a sweep, for one azimuth.
std::vector<BeamPlace> beam_places(const GateField& field, double elevation_deg,
                                   const LayerHeights& layer) {
    // The latitude hardly matters: it changes heights by less than 0.2 %.
    const grid::BeamGeometry beam(40, 0);
    std::vector<BeamPlace> places(field.gates);
    for (std::size_t gate = 0; gate < places.size(); ++gate) {
        const auto height_at = [&](double deviation_deg) {
            return beam.forward({field.range_m(gate), elevation_deg + deviation_deg}).height_m;
        };
        places[gate] =
            place_of(layer, height_at(-half_beam_deg), height_at(0), height_at(half_beam_deg));
    }
    return places;
}

// Returns the places of the beam for each sector of the melting layer.
std::vector<std::vector<BeamPlace>> places_by_sector(const GateField& field, double elevation_deg,
                                                     const MeltingLayer& layer) {
    std::vector<std::vector<BeamPlace>> places;
    for (const auto& sector : layer.sectors)
        places.push_back(beam_places(field, elevation_deg, sector.value_or(layer.heights)));
    return places;
}

// Returns none if the moment has no gates.
std::optional<SweepHydrometeors> classify(const level2::Volume& volume, std::size_t number,
                                          std::size_t moment, const MeltingLayer& layer,
                                          const SweepKdp* kdp) {
    const level2::Sweep& sweep = volume.sweeps[number];
    const GateField field = gate_field(sweep, sweep.moments[moment]);
    if (field.is_empty()) return std::nullopt;
    SweepHydrometeors made{number, moment, {}};
    made.classes.assign(field.codes.size(), Hydrometeor::none);
    const EchoGates echo(field);
    const VariablesOfSweep variables(volume, number, field, echo, kdp);
    const auto places = places_by_sector(field, sweep.mean_elevation_deg(), layer);
    for (std::size_t radial = 0; radial < field.radials; ++radial) {
        const auto azimuth = static_cast<double>(sweep.radials[radial].azimuth_deg);
        const auto& here = places[MeltingLayer::sector_of(azimuth)];
        std::size_t i = echo.begin(radial);
        for (const std::uint32_t gate : echo.of(radial))
            made.classes[radial * field.gates + gate] = best_class(variables[i++], here[gate]);
    }
    return made;
}

MeltingLayer assumed_layer(const level2::Volume& volume, double zero_c_m) {
    const auto antenna = level2::antenna_position(volume);
    const double top = zero_c_m - (antenna ? antenna->altitude_m : 0);
    MeltingLayer layer;
    layer.heights = {top - assumed_depth_m, top, assumed_depth_m, assumed_depth_m};
    return layer;
}

std::string layer_text(const LayerHeights& heights) {
    return fmt::format("from {:.0f} to {:.0f} m above the antenna", heights.bottom_m,
                       heights.top_m);
}

}  // namespace

std::string_view hydrometeor_name(Hydrometeor kind) {
    static constexpr std::array<std::string_view, hydrometeor_count> names = {
        "none", "biological", "ground clutter", "ice crystals", "dry snow", "wet snow",
        "rain", "heavy rain", "big drops",      "graupel",      "hail",
    };
    return names[static_cast<std::size_t>(kind)];
}

Hydrometeor hydrometeor_of_number(float number) {
    for (std::size_t i = 1; i < hydrometeor_count; ++i)
        if (const auto kind = static_cast<Hydrometeor>(i); hydrometeor_number(kind) == number)
            return kind;
    return Hydrometeor::none;
}

std::vector<SweepHydrometeors> hydrometeors(const level2::Volume& volume,
                                            const MeltingLayer& layer) {
    const std::vector<SweepKdp> all = specific_differential_phases(volume);
    std::vector<SweepHydrometeors> made;
    for (std::size_t sweep = 0; sweep < volume.sweeps.size(); ++sweep) {
        if (!has_dual_polarization(volume.sweeps[sweep])) continue;
        const auto kdp = std::ranges::find(all, sweep, &SweepKdp::sweep);
        const auto& moments = volume.sweeps[sweep].moments;
        for (std::size_t moment = 0; moment < moments.size(); ++moment) {
            if (moments[moment].moment != Moment::ref) continue;
            auto of = classify(volume, sweep, moment, layer, kdp != all.end() ? &*kdp : nullptr);
            if (of) made.push_back(std::move(*of));
        }
    }
    return made;
}

Hydrometeors hydrometeors(const level2::Volume& volume, double zero_c_m) {
    const auto found = melting_layer(volume);
    const MeltingLayer layer = found ? *found : assumed_layer(volume, zero_c_m);
    const std::string text = layer_text(layer.heights);
    return {hydrometeors(volume, layer),
            found ? text
                  : fmt::format("assumed {}{}{:.0f} m above sea level: {}", text,
                                class_zero_c_words, zero_c_m, found.error().message)};
}

std::optional<double> assumed_zero_c_in_notes(std::span<const std::string> notes) {
    for (const std::string& note : notes) {
        if (note.find(hydrometeor_words) == note.npos) continue;
        const std::size_t at = note.find(class_zero_c_words);
        if (at != note.npos)
            return std::strtod(note.c_str() + at + class_zero_c_words.size(), nullptr);
    }
    return std::nullopt;
}

}  // namespace stormcellar::retrieve
