#include "grid/beam/gate_places.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::grid {
namespace {

bool is_somewhere(const EarthPoint& point) {
    return std::isfinite(point.arc_m) && std::isfinite(point.height_m);
}

// Returns the point that mirrors `other` about `middle`.
EarthPoint mirrored(const EarthPoint& other, const EarthPoint& middle) {
    return {2 * middle.arc_m - other.arc_m, 2 * middle.height_m - other.height_m};
}

}  // namespace

GatePlaces::GatePlaces(const level2::SweepMoment& moment, const BeamModel& beam,
                       double elevation_deg, double half_beam_deg)
    : half_beam_deg_(half_beam_deg) {
    const BeamPath middle = beam.path(elevation_deg);
    const BeamPath lower = beam.path(elevation_deg - half_beam_deg);
    const BeamPath upper = beam.path(elevation_deg + half_beam_deg);
    places_.reserve(static_cast<std::size_t>(std::max(moment.gate_stride, 0)));
    for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate) {
        const double range_m = moment.range_m(gate);
        Place place;
        place.middle = middle.at(range_m);
        // A traced beam may end at the ground. Then mirror the other edge to get the missing point.
        EarthPoint low = lower.at(range_m);
        EarthPoint high = upper.at(range_m);
        if (!is_somewhere(low)) low = mirrored(high, place.middle);
        if (!is_somewhere(high)) high = mirrored(low, place.middle);
        place.linear = {(high.arc_m - low.arc_m) / 2, (high.height_m - low.height_m) / 2};
        place.square = {(high.arc_m + low.arc_m) / 2 - place.middle.arc_m,
                        (high.height_m + low.height_m) / 2 - place.middle.height_m};
        places_.push_back(place);
    }
}

std::optional<EarthPoint> GatePlaces::at(std::int32_t gate, double offset_deg) const {
    if (gate < 0 || static_cast<std::size_t>(gate) >= places_.size()) return std::nullopt;
    const Place& place = places_[static_cast<std::size_t>(gate)];
    const double halves = offset_deg / half_beam_deg_;
    const auto along = [&](double middle, double linear, double square) {
        return middle + halves * (linear + halves * square);
    };
    const EarthPoint point{
        along(place.middle.arc_m, place.linear.arc_m, place.square.arc_m),
        along(place.middle.height_m, place.linear.height_m, place.square.height_m)};
    if (!is_somewhere(point)) return std::nullopt;
    return point;
}

}  // namespace stormcellar::grid
