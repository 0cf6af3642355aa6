#include "tests/grid/slow_details.h"

#include <algorithm>
#include <cmath>

#include <GeographicLib/AzimuthalEquidistant.hpp>
#include <GeographicLib/Geodesic.hpp>

namespace stormcellar::grid {
namespace {

using Real = long double;
constexpr Real degree = 3.14159265358979323846264338327950288L / 180;
constexpr Real doubt_range_m = 0.25L;
constexpr Real doubt_azimuth_deg = 1e-4L;
constexpr Real doubt_height_m = 1;

Real turn_to(Real from_deg, Real to_deg) {
    return std::remainder(to_deg - from_deg, 360.0L);
}

}  // namespace

Real SlowColumn::arc_of(Real range_m, Real elevation_deg) const {
    const Real e = elevation_deg * degree;
    return radius_m_ *
           std::atan2(range_m * std::cos(e), radius_m_ + altitude_m_ + range_m * std::sin(e));
}

Real SlowColumn::height_of(Real range_m, Real elevation_deg) const {
    const Real a = radius_m_ + altitude_m_;
    const Real e = elevation_deg * degree;
    return std::sqrt(range_m * range_m + a * a + 2 * range_m * a * std::sin(e)) - radius_m_;
}

Real SlowColumn::range_over(Real arc_m, Real elevation_deg) const {
    Real near_m = 0;
    Real far_m = 4e6;
    for (int i = 0; i < 80; ++i) {
        const Real middle_m = (near_m + far_m) / 2;
        (arc_of(middle_m, elevation_deg) < arc_m ? near_m : far_m) = middle_m;
    }
    return near_m;
}

SlowColumn::SlowColumn(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                       const Setting& setting, const SitePosition& site, const GridSpec& spec,
                       int ix, int iy)
    : setting_(setting), altitude_m_(site.altitude_m) {
    const Real a = 6378137;
    const Real f = 1 / 298.257223563L;
    const Real e2 = f * (2 - f);
    const Real s = std::sin(site.latitude_deg * degree);
    radius_m_ = a * std::sqrt(1 - e2) / (1 - e2 * s * s) * 4 / 3;
    double latitude_deg = 0;
    double longitude_deg = 0;
    double arc_m = 0;
    double azimuth_deg = 0;
    double there_deg = 0;
    GeographicLib::AzimuthalEquidistant().Reverse(
        spec.center_latitude_deg, spec.center_longitude_deg,
        (ix - 0.5 * (spec.nx - 1)) * spec.spacing_m, (iy - 0.5 * (spec.ny - 1)) * spec.spacing_m,
        latitude_deg, longitude_deg);
    GeographicLib::Geodesic::WGS84().Inverse(site.latitude_deg, site.longitude_deg, latitude_deg,
                                             longitude_deg, arc_m, azimuth_deg, there_deg);
    for (const ChosenSweep& choice : chosen)
        add_sweep(volume.sweeps[choice.sweep_index], choice, {azimuth_deg, arc_m});
    // A lost cut keeps its position in the order, whatever beams are beside it.
    std::vector<bool> adjacent;
    for (const Beam& beam : beams_)
        adjacent.push_back(beam.adjacent_to_next);
    std::stable_sort(beams_.begin(), beams_.end(),
                     [](const Beam& x, const Beam& y) { return x.height_m < y.height_m; });
    for (std::size_t i = 0; i < beams_.size(); ++i) {
        beams_[i].adjacent_to_next = adjacent[i];
        if (i > 0 && beams_[i].height_m - beams_[i - 1].height_m < doubt_height_m) doubtful_ = true;
    }
}

std::optional<std::uint32_t> SlowColumn::nearest_radial(const level2::Sweep& sweep,
                                                        const ChosenSweep& chosen,
                                                        Real azimuth_deg) {
    // The nearest radial on each side with its distance, and the nearer of the two.
    Real left_deg = 1e9L;
    Real right_deg = 1e9L;
    std::uint32_t left = 0;
    std::uint32_t right = 0;
    std::vector<float> azimuths_deg;
    for (const std::uint32_t radial : chosen.radials) {
        azimuths_deg.push_back(*normal_azimuth(sweep.radials[radial].azimuth_deg));
        const Real turn_deg = turn_to(azimuth_deg, azimuths_deg.back());
        // If two radials have equal azimuths, the later radial counts.
        if (turn_deg >= 0 && turn_deg <= right_deg) {
            right_deg = turn_deg;
            right = radial;
        } else if (turn_deg < 0 && -turn_deg <= left_deg) {
            left_deg = -turn_deg;
            left = radial;
        }
    }
    std::sort(azimuths_deg.begin(), azimuths_deg.end());
    const Real spacing_deg = azimuth_spacing_deg(azimuths_deg, sweep.azimuth_spacing_deg);
    const Real near_deg = std::min(left_deg, right_deg);
    const std::uint32_t nearest = left_deg < right_deg ? left : right;
    if (left_deg + right_deg <= 1.5L * spacing_deg) {
        if (std::abs(left_deg - right_deg) < 2 * doubt_azimuth_deg) doubtful_ = true;
        return nearest;
    }
    if (std::abs(near_deg - spacing_deg / 2) < doubt_azimuth_deg) doubtful_ = true;
    if (near_deg > spacing_deg / 2) return std::nullopt;
    return nearest;
}

void SlowColumn::add_sweep(const level2::Sweep& sweep, const ChosenSweep& chosen,
                           const Place& column) {
    // If this angle is 89.9 degrees or more, the beam has no height over this arc.
    const Real angle = chosen.elevation_deg * degree + column.arc_m / radius_m_;
    if (!(angle < 89.9L * degree)) return;
    Beam beam;
    beam.sweep = chosen.sweep_index;
    beam.adjacent_to_next = chosen.adjacent_to_next;
    const auto radial = nearest_radial(sweep, chosen, column.azimuth_deg);
    const Real elevation_deg =
        radial ? static_cast<Real>(sweep.radials[*radial].elevation_deg) : chosen.elevation_deg;
    const auto height = [&](Real deg) { return height_of(range_over(column.arc_m, deg), deg); };
    beam.height_m = height(elevation_deg);
    beam.lower_m = height(elevation_deg - setting_.beam_width_deg / 2);
    beam.upper_m = height(elevation_deg + setting_.beam_width_deg / 2);
    if (radial) {
        look_at_gate(sweep, *radial, range_over(column.arc_m, chosen.elevation_deg), column, beam);
    }
    beams_.push_back(beam);
}

void SlowColumn::look_at_gate(const level2::Sweep& sweep, std::uint32_t radial, Real range_m,
                              const Place& column, Beam& beam) {
    const level2::SweepMoment* kind = nullptr;
    for (const level2::SweepMoment& moment : sweep.moments) {
        const bool has = moment.moment == setting_.moment && moment.gate_counts[radial] > 0;
        if (has && kind == nullptr) kind = &moment;
    }
    if (kind == nullptr) return;
    const Real number = (range_m - kind->first_gate_m) / kind->gate_spacing_m;
    const auto gate = static_cast<std::int32_t>(std::floor(number + 0.5L));
    if (number > kind->gate_counts[radial] + 1) return;
    if ((0.5L - std::abs(number - gate)) * kind->gate_spacing_m < doubt_range_m) doubtful_ = true;
    if (gate < 0 || kind->range_m(gate) < 0) return;
    if (kind->status(radial, gate) == level2::GateStatus::no_data) return;
    const level2::Radial& header = sweep.radials[radial];
    beam.is_seen = true;
    if (setting_.frame_time && level2::is_plausible(header.time)) {
        beam.age_s = static_cast<Real>((header.time - *setting_.frame_time).count()) / 1000;
    }
    const Real gate_m = kind->range_m(gate);
    const Real arc_m = arc_of(gate_m, header.elevation_deg);
    beam.gate_height_m = height_of(gate_m, header.elevation_deg);
    const auto east = [](Real arc, Real deg) { return arc * std::sin(deg * degree); };
    const auto north = [](Real arc, Real deg) { return arc * std::cos(deg * degree); };
    const Real at_deg = header.azimuth_deg;
    beam.gate_off_m = std::hypot(east(column.arc_m, column.azimuth_deg) - east(arc_m, at_deg),
                                 north(column.arc_m, column.azimuth_deg) - north(arc_m, at_deg));
}

std::vector<std::pair<const SlowColumn::Beam*, Real>> SlowColumn::shares(Real height_m) const {
    const auto within = [&](const Beam& beam) {
        return height_m >= beam.lower_m && height_m <= beam.upper_m;
    };
    const Beam* low = nullptr;
    const Beam* high = nullptr;
    for (const Beam& beam : beams_) {
        if (beam.height_m <= height_m) low = &beam;
        if (beam.height_m > height_m && high == nullptr) high = &beam;
    }
    if (low != nullptr && high != nullptr && low->adjacent_to_next) {
        const Real weight = (height_m - low->height_m) / (high->height_m - low->height_m);
        if (setting_.nearest) return {{weight > 0.5L ? high : low, 1}};
        return {{low, 1 - weight}, {high, weight}};
    }
    const bool low_is_nearer = low != nullptr && (high == nullptr || height_m - low->height_m <=
                                                                         high->height_m - height_m);
    const Beam* first = low_is_nearer ? low : high;
    const Beam* second = low_is_nearer ? high : low;
    if (first != nullptr && within(*first)) return {{first, 1}};
    if (second != nullptr && within(*second)) return {{second, 1}};
    return {};
}

SlowDetails SlowColumn::at(double height_m) const {
    SlowDetails details;
    Real seen = 0;
    Real age_s = 0;
    bool dated = true;
    for (const auto& [beam, weight] : shares(height_m)) {
        details.sweeps.push_back(beam->sweep);
        if (!beam->is_seen) continue;
        seen += weight;
        dated = dated && beam->age_s;
        age_s += weight * beam->age_s.value_or(0);
        const Real above_m = height_m - beam->height_m;
        if (!details.height_offset_m || std::abs(above_m) < std::abs(*details.height_offset_m)) {
            details.height_offset_m = static_cast<double>(above_m);
            details.nearest = beam->sweep;
        }
        const auto far_m =
            static_cast<double>(std::hypot(height_m - beam->gate_height_m, beam->gate_off_m));
        details.distance_m = std::min(details.distance_m.value_or(far_m), far_m);
    }
    details.seen = static_cast<double>(seen);
    if (details.height_offset_m && dated) details.age_s = static_cast<double>(age_s / seen);
    return details;
}

}  // namespace stormcellar::grid
