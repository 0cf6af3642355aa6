#include "web/data/station/sweep_places.h"

#include <algorithm>
#include <cmath>

#include "web/data/station/moment_names.h"

namespace stormcellar::web {
namespace {

constexpr const char* shared_axis = "range";

// Returns the axes of a sweep, and the axis of each of its moments.
std::pair<std::vector<GateAxis>, std::vector<PlacedMoment>> axes_of(const level2::Sweep& sweep) {
    const level2::SweepMoment& finest = finest_array(sweep);
    std::vector<GateAxis> axes{{shared_axis, finest.first_gate_m, finest.gate_spacing_m, 0}};
    std::vector<PlacedMoment> moments;
    for (const level2::SweepMoment* array : first_arrays(sweep)) {
        const int repeats = repeats_on(*array, finest.first_gate_m, finest.gate_spacing_m);
        const auto gates = static_cast<std::size_t>(array->gate_stride);
        std::string name = shared_axis;
        if (repeats > 0) {
            axes.front().gates =
                std::max(axes.front().gates, gates * static_cast<std::size_t>(repeats));
        } else {
            name = "range_" + std::string(fm301_names(array->moment).name);
            axes.push_back({name, array->first_gate_m, array->gate_spacing_m, gates});
        }
        moments.push_back({array->moment, std::move(name)});
    }
    return {std::move(axes), std::move(moments)};
}

}  // namespace

const GateAxis& SweepPlace::axis_of(const PlacedMoment& moment) const {
    return *std::ranges::find(axes, moment.axis, &GateAxis::name);
}

std::size_t SweepPlace::azimuths() const {
    return kind.azimuth_spacing_deg < 1 ? 720 : 360;
}

int repeats_on(const level2::SweepMoment& array, std::int32_t first_gate_m,
               std::int32_t gate_spacing_m) {
    if (gate_spacing_m <= 0 || array.gate_spacing_m <= 0) return 0;
    if (array.gate_spacing_m % gate_spacing_m != 0) return 0;
    // Twice the distance of the near end of the first gate.
    const auto begin_of = [](std::int64_t first_m, std::int64_t spacing_m) {
        return 2 * first_m - spacing_m;
    };
    const bool fits = begin_of(array.first_gate_m, array.gate_spacing_m) ==
                      begin_of(first_gate_m, gate_spacing_m);
    return fits ? array.gate_spacing_m / gate_spacing_m : 0;
}

VolumeSize size_of_volume(int sweeps, int radials) {
    return {sweeps, std::lrint(radials / 360.0)};
}

// Of two kinds that are equally near, returns the one that was learned first.
std::optional<std::size_t> SweepPlaces::nearest_kind(const SweepKind& kind) const {
    std::optional<std::size_t> nearest;
    double least = 0;
    for (std::size_t i = 0; i < kinds_.size(); ++i) {
        if (!kinds_[i].is_like(kind)) continue;
        const double apart = std::abs(kinds_[i].angle_deg - kind.angle_deg);
        if (nearest && apart >= least) continue;
        nearest = i;
        least = apart;
    }
    return nearest;
}

void SweepPlaces::join(SweepPlace& place, const level2::Sweep& sweep) {
    auto [axes, moments] = axes_of(sweep);
    for (PlacedMoment& moment : moments) {
        if (std::ranges::find(place.moments, moment.moment, &PlacedMoment::moment) ==
            place.moments.end())
            place.moments.push_back(std::move(moment));
    }
    for (GateAxis& axis : axes) {
        const auto known = std::ranges::find(place.axes, axis.name, &GateAxis::name);
        if (known == place.axes.end()) {
            place.axes.push_back(std::move(axis));
        } else if (known->first_gate_m == axis.first_gate_m &&
                   known->gate_spacing_m == axis.gate_spacing_m) {
            known->gates = std::max(known->gates, axis.gates);
        }
    }
}

void SweepPlaces::learn(const level2::Volume& volume, VolumeSize size) {
    std::map<std::size_t, int> seen;
    bool is_first = true;
    for (const level2::Sweep* sweep : cuts_of(volume)) {
        const SweepKind kind = kind_of_sweep(*sweep);
        auto index = nearest_kind(kind);
        if (!index) {
            if (kinds_.size() == most) continue;
            index = kinds_.size();
            kinds_.push_back(kind);
        }
        const Key key{*index, seen[*index]++};
        auto number = numbers_.find(key);
        if (number == numbers_.end()) {
            if (places_.size() == most) continue;
            number = numbers_.emplace(key, places_.size()).first;
            places_.push_back({.kind = kinds_[*index],
                               .occurrence = key.second,
                               .fixed_angle_deg = fixed_angle_of(*sweep)});
            kind_of_place_.push_back(*index);
        }
        join(places_[number->second], *sweep);
        cuts_[{size, number->second}] = {sweep->elevation_number, is_first};
        is_first = false;
    }
}

const level2::Sweep* SweepPlaces::find(const level2::Volume& volume, std::size_t place) const {
    std::map<std::optional<std::size_t>, int> seen;
    for (const level2::Sweep* sweep : cuts_of(volume)) {
        const auto index = nearest_kind(kind_of_sweep(*sweep));
        const int before = seen[index]++;
        if (!index) continue;
        const auto number = numbers_.find({*index, before});
        if (number != numbers_.end() && number->second == place) return sweep;
    }
    return nullptr;
}

std::optional<int> SweepPlaces::cut_of(VolumeSize size, std::size_t place) const {
    const auto cut = cuts_.find({size, place});
    if (cut == cuts_.end()) return std::nullopt;
    const bool is_repeated = numbers_.contains({kind_of_place_[place], 1});
    if (is_repeated && !cut->second.is_first) return std::nullopt;
    return cut->second.elevation_number;
}

bool SweepPlaces::is_of_place(const level2::Sweep& sweep, std::size_t place) const {
    return nearest_kind(kind_of_sweep(sweep)) == kind_of_place_[place];
}

}  // namespace stormcellar::web
