#include "tests/grid/slow_gridder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <GeographicLib/AzimuthalEquidistant.hpp>
#include <GeographicLib/Geodesic.hpp>

#include "base/station_table.h"
#include "grid/detection_limit.h"

namespace stormcellar::grid {
namespace {

using Real = long double;
constexpr Real degree = 3.14159265358979323846264338327950288L / 180;
constexpr double doubtful_range_m = 0.2;
constexpr double doubtful_azimuth_deg = 1e-4;

struct Line {
    double range_m, height_m;
};

// Walks along the beam until it stands over the arc: bisection on the textbook's formulae.
Line beam_over(Real radius_m, Real altitude_m, Real elevation_deg, Real arc_m) {
    const Real a = radius_m + altitude_m;
    const Real e = elevation_deg * degree;
    const auto height_of = [&](Real r) {
        return std::sqrt(r * r + a * a + 2 * r * a * std::sin(e)) - a;
    };
    const auto arc_of = [&](Real r) {
        return radius_m * std::atan2(r * std::cos(e), a + r * std::sin(e));
    };
    Real near_m = 0;
    Real far_m = 4e6;
    for (int i = 0; i < 80; ++i) {
        const Real middle_m = (near_m + far_m) / 2;
        (arc_of(middle_m) < arc_m ? near_m : far_m) = middle_m;
    }
    return {static_cast<double>(near_m), static_cast<double>(altitude_m + height_of(near_m))};
}

Real gaussian_radius(Real latitude_deg) {
    const Real a = 6378137;
    const Real f = 1 / 298.257223563L;
    const Real e2 = f * (2 - f);
    const Real s = std::sin(latitude_deg * degree);
    const Real m = a * (1 - e2) / std::pow(1 - e2 * s * s, 1.5L);
    const Real n = a / std::sqrt(1 - e2 * s * s);
    return std::sqrt(m * n);
}

double median_step(std::vector<double> azimuths_deg) {
    std::sort(azimuths_deg.begin(), azimuths_deg.end());
    std::vector<double> steps_deg;
    for (std::size_t i = 1; i < azimuths_deg.size(); ++i)
        steps_deg.push_back(azimuths_deg[i] - azimuths_deg[i - 1]);
    if (steps_deg.empty()) return 0;
    std::sort(steps_deg.begin(), steps_deg.end());
    return steps_deg[steps_deg.size() / 2];
}

}  // namespace

SlowColumn::SlowColumn(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                       level2::Moment moment, const SitePosition& site, const GridSpec& spec,
                       int ix, int iy, double beam_width_deg)
    : moment_(moment) {
    double latitude_deg = 0;
    double longitude_deg = 0;
    GeographicLib::AzimuthalEquidistant().Reverse(spec.center_latitude_deg,
                                                  spec.center_longitude_deg, spec.x_m(ix),
                                                  spec.y_m(iy), latitude_deg, longitude_deg);
    double arc_m = 0;
    double azimuth_deg = 0;
    double there_deg = 0;
    GeographicLib::Geodesic::WGS84().Inverse(site.latitude_deg, site.longitude_deg, latitude_deg,
                                             longitude_deg, arc_m, azimuth_deg, there_deg);
    azimuth_deg = std::fmod(azimuth_deg + 360, 360);
    const Real radius_m = gaussian_radius(site.latitude_deg) * 4 / 3;
    for (const ChosenSweep& sweep : chosen) {
        Beam beam;
        const Line center = beam_over(radius_m, site.altitude_m, sweep.elevation_deg, arc_m);
        beam.height_m = center.height_m;
        beam.lower_edge_m =
            beam_over(radius_m, site.altitude_m, sweep.elevation_deg - beam_width_deg / 2, arc_m)
                .height_m;
        beam.upper_edge_m =
            beam_over(radius_m, site.altitude_m, sweep.elevation_deg + beam_width_deg / 2, arc_m)
                .height_m;
        beam.adjacent_to_next = sweep.adjacent_to_next;
        sample(volume.sweeps[sweep.sweep_index], sweep, moment, azimuth_deg, center.range_m, beam);
        beams_.push_back(beam);
    }
}

void SlowColumn::sample(const level2::Sweep& sweep, const ChosenSweep& chosen,
                        level2::Moment moment, double azimuth_deg, double range_m, Beam& beam) {
    // The nearest radial to the left and to the right, the later one of equal ones.
    double left_deg = 1e9;
    double right_deg = 1e9;
    std::uint32_t left = 0;
    std::uint32_t right = 0;
    std::vector<double> azimuths_deg;
    for (const std::uint32_t radial : chosen.radials) {
        const double its_deg = sweep.radials[radial].azimuth_deg;
        azimuths_deg.push_back(std::fmod(its_deg + 360, 360));
        const double behind_deg = std::fmod(azimuth_deg - its_deg + 720, 360);
        const double ahead_deg = std::fmod(its_deg - azimuth_deg + 720, 360);
        if (behind_deg <= left_deg) left_deg = behind_deg, left = radial;
        if (ahead_deg <= right_deg) right_deg = ahead_deg, right = radial;
    }
    const double spacing_deg =
        std::min(2.0, std::max<double>(sweep.azimuth_spacing_deg, median_step(azimuths_deg)));
    const double nearest_deg = std::min(left_deg, right_deg);
    const bool gap = left_deg + right_deg > 1.5 * spacing_deg;
    const double margin_deg =
        gap ? std::abs(nearest_deg - spacing_deg / 2) : std::abs(left_deg - right_deg);
    const bool gap_in_doubt =
        std::abs(left_deg + right_deg - 1.5 * spacing_deg) < doubtful_azimuth_deg;
    if (margin_deg < doubtful_azimuth_deg || gap_in_doubt) doubtful_ = true;
    if (gap && nearest_deg > spacing_deg / 2) return;
    const std::uint32_t radial = left_deg < right_deg ? left : right;

    for (const level2::SweepMoment& kind : sweep.moments) {
        if (kind.moment != moment || kind.gate_counts[radial] == 0) continue;
        const double number = (range_m - kind.first_gate_m) / kind.gate_spacing_m;
        const auto gate = static_cast<std::int32_t>(std::floor(number + 0.5));
        const double to_border_m =
            (0.5 - std::abs(number - std::round(number))) * kind.gate_spacing_m;
        if (to_border_m < doubtful_range_m) doubtful_ = true;
        if (gate < 0 || kind.range_m(gate) < 0) return;
        switch (kind.status(radial, gate)) {
            case level2::GateStatus::no_data:
                return;
            case level2::GateStatus::range_folded:
                beam.status = CellStatus::range_folded;
                return;
            case level2::GateStatus::valid:
                beam.status = CellStatus::value;
                beam.value = static_cast<double>(kind.value_of(kind.code(radial, gate)));
                return;
            case level2::GateStatus::below_threshold:
                beam.status = CellStatus::no_echo;
                beam.limit_dbz =
                    detection_limit(sweep.radials[radial], kind, false).at(kind.range_m(gate));
                return;
        }
    }
}

SlowCell SlowColumn::cell(double level_m) const {
    const auto only = [](const Beam& beam) { return SlowCell{beam.status, beam.value}; };
    const Beam* below = nullptr;
    const Beam* above = nullptr;
    for (const Beam& beam : beams_) {
        if (beam.height_m <= level_m) below = &beam;
        if (beam.height_m > level_m && above == nullptr) above = &beam;
    }
    if (below == nullptr && above == nullptr) return {};
    if (below == nullptr) return level_m >= above->lower_edge_m ? only(*above) : SlowCell{};
    if (above == nullptr) return level_m <= below->upper_edge_m ? only(*below) : SlowCell{};
    if (!below->adjacent_to_next) {
        const bool within_below = level_m <= below->upper_edge_m;
        const bool within_above = level_m >= above->lower_edge_m;
        if (within_below && within_above) {
            return only(level_m - below->height_m <= above->height_m - level_m ? *below : *above);
        }
        if (within_below) return only(*below);
        return within_above ? only(*above) : SlowCell{};
    }
    const double share = (level_m - below->height_m) / (above->height_m - below->height_m);
    std::array<double, 4> weight{};
    weight[static_cast<std::size_t>(below->status)] += 1 - share;
    weight[static_cast<std::size_t>(above->status)] += share;
    const auto [u, n, f, v] = weight;
    if (u > 0.5) return {CellStatus::not_seen, 0};
    if (f > v && f > n) return {CellStatus::range_folded, 0};
    if (v < n) return {CellStatus::no_echo, 0};
    const bool limits_count = moment_ == level2::Moment::ref;
    double sum = 0;
    double total = 0;
    for (const auto& [beam, its_weight] : {std::pair{below, 1 - share}, {above, share}}) {
        if (beam->status == CellStatus::value) sum += its_weight * beam->value, total += its_weight;
        if (beam->status == CellStatus::no_echo && limits_count) {
            sum += its_weight * beam->limit_dbz;
            total += its_weight;
        }
    }
    return {CellStatus::value, sum / total};
}

}  // namespace stormcellar::grid
