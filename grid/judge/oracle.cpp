#include "grid/judge/oracle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <GeographicLib/AzimuthalEquidistant.hpp>
#include <GeographicLib/Geodesic.hpp>

#include "base/floating_point.h"
#include "grid/sweep/mixture.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

using Real = long double;
constexpr Real degree = 3.14159265358979323846264338327950288L / 180;
constexpr int parts_of_a_level = 4;

Real gaussian_radius(Real latitude_deg) {
    const Real a = 6378137;
    const Real f = 1 / 298.257223563L;
    const Real e2 = f * (2 - f);
    const Real s = std::sin(latitude_deg * degree);
    const Real m = a * (1 - e2) / std::pow(1 - e2 * s * s, 1.5L);
    const Real n = a / std::sqrt(1 - e2 * s * s);
    return std::sqrt(m * n);
}

// The beam of the 4/3 earth, by the textbook's formulas, or by bisection where there is no closed
// formula. Other beams have oracles of their own (tests/grid/beam_model_test.cpp).
class Beamline {
  public:
    Beamline(const SitePosition& site, const OracleSetting& setting)
        : radius_m_(gaussian_radius(site.latitude_deg) * 4 / 3), altitude_m_(site.altitude_m) {
        if (setting.method.beam == BeamKind::flat_earth) {
            model_ = BeamModel::flat_earth(site.altitude_m);
        } else if (setting.method.beam == BeamKind::traced) {
            model_ = BeamModel::traced(site.latitude_deg, site.altitude_m,
                                       setting.profile.value_or(RefractivityProfile::reference()));
        }
    }

    [[nodiscard]] Real arc_of(Real range_m, Real elevation_deg) const {
        if (model_) {
            return model_->path(static_cast<double>(elevation_deg))
                .at(static_cast<double>(range_m))
                .arc_m;
        }
        const Real e = elevation_deg * degree;
        return radius_m_ *
               std::atan2(range_m * std::cos(e), radius_m_ + altitude_m_ + range_m * std::sin(e));
    }
    // Returns NaN where the beam never passes over the arc.
    [[nodiscard]] BeamGeometry::BeamPoint over(double arc_m, double elevation_deg) const {
        if (model_) return model_->path(elevation_deg).over(arc_m);
        Real near_m = 0;
        Real far_m = 4e6;
        for (int i = 0; i < 80; ++i) {
            const Real middle_m = (near_m + far_m) / 2;
            (arc_of(middle_m, elevation_deg) < arc_m ? near_m : far_m) = middle_m;
        }
        const Real r = near_m;
        const Real a = radius_m_ + altitude_m_;
        const Real e = elevation_deg * degree;
        const Real height_m =
            altitude_m_ + (std::sqrt(r * r + a * a + 2 * r * a * std::sin(e)) - a);
        return {static_cast<double>(r), static_cast<double>(height_m)};
    }

  private:
    Real radius_m_, altitude_m_;
    std::optional<BeamModel> model_;
};

// A column of a spec: its place, and a test that tells whether a gate is inside its outline.
class Outline {
  public:
    Outline(const SitePosition& site, const GridSpec& spec, int ix, int iy)
        : projection_(spec), site_(site), spec_(spec), ix_(ix), iy_(iy) {
        const PolarPoint center = as_seen(ix, iy);
        azimuth_deg = center.azimuth_deg;
        arc_m = center.arc_m;
        const auto plane = [](PolarPoint point) {
            const double azimuth = point.azimuth_deg * static_cast<double>(degree);
            return std::array{point.arc_m * std::sin(azimuth), point.arc_m * std::cos(azimuth)};
        };
        const auto middle = plane(center);
        for (const double x : {-0.5, 0.5}) {
            for (const double y : {-0.5, 0.5}) {
                const auto corner = plane(as_seen(ix + x, iy + y));
                radius_m =
                    std::max(radius_m, std::hypot(corner[0] - middle[0], corner[1] - middle[1]));
            }
        }
    }
    [[nodiscard]] bool holds(double azimuth, double arc) const {
        const MaskedTraps masked;
        GeoPoint place;
        GeographicLib::Geodesic::WGS84().Direct(site_.latitude_deg, site_.longitude_deg, azimuth,
                                                arc, place.latitude_deg, place.longitude_deg);
        const ColumnPoint column = projection_.to_column(place);
        return std::abs(column.x - ix_) <= 0.5 && std::abs(column.y - iy_) <= 0.5;
    }
    double azimuth_deg = 0, arc_m = 0, radius_m = 0;

  private:
    // Computes the azimuthal equidistant projection without GridProjection. Uses GridProjection for
    // the other projections, which have an oracle of their own (tests/grid/projection_test.cpp).
    [[nodiscard]] PolarPoint as_seen(double x, double y) const {
        const MaskedTraps masked;
        GeoPoint place = projection_.to_geo({x, y});
        if (spec_.projection == Projection::azimuthal_equidistant) {
            GeographicLib::AzimuthalEquidistant().Reverse(
                spec_.center_latitude_deg, spec_.center_longitude_deg,
                (x - 0.5 * (spec_.nx - 1) + spec_.offset_x_cells) * spec_.spacing_m,
                (y - 0.5 * (spec_.ny - 1) + spec_.offset_y_cells) * spec_.spacing_m,
                place.latitude_deg, place.longitude_deg);
        }
        PolarPoint polar;
        double there_deg = 0;
        GeographicLib::Geodesic::WGS84().Inverse(site_.latitude_deg, site_.longitude_deg,
                                                 place.latitude_deg, place.longitude_deg,
                                                 polar.arc_m, polar.azimuth_deg, there_deg);
        polar.azimuth_deg = std::fmod(polar.azimuth_deg + 360, 360);
        return polar;
    }

    GridProjection projection_;
    const SitePosition& site_;
    const GridSpec& spec_;
    int ix_, iy_;
};

}  // namespace

OracleColumn::OracleColumn(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                           const OracleSetting& setting, const SitePosition& site,
                           const GridSpec& spec, int ix, int iy)
    : setting_(setting), levels_m_(spec.levels_m) {
    const Outline outline(site, spec, ix, iy);
    const Beamline line(site, setting);
    for (const ChosenSweep& choice : chosen) {
        const OracleSweep sweep(volume.sweeps[choice.sweep_index], choice, setting);
        Beam beam;
        beam.adjacent_to_next = choice.adjacent_to_next;
        const double range_m = line.over(outline.arc_m, choice.elevation_deg).range_m;
        if (std::isnan(range_m)) continue;
        if (setting.method.cell == CellExtent::area) {
            const bool is_far = outline.arc_m > outline.radius_m;
            const double near_deg =
                is_far ? std::asin(outline.radius_m / outline.arc_m) / static_cast<double>(degree)
                       : 180;
            const auto inside = [&](double azimuth_deg, double gate_m) {
                return outline.holds(
                    azimuth_deg, static_cast<double>(line.arc_of(gate_m, choice.elevation_deg)));
            };
            beam.gates =
                sweep.inside(inside, outline.azimuth_deg, near_deg,
                             range_m - 2.5 * outline.radius_m, range_m + 2.5 * outline.radius_m);
        }
        if (beam.gates.empty()) {
            beam.gates = sweep.point(outline.azimuth_deg, range_m, doubtful_);
        }
        const double elevation_deg = setting.method.radial_elevations
                                         ? sweep.elevation_deg(outline.azimuth_deg, doubtful_)
                                         : choice.elevation_deg;
        const double half_deg = setting.beam_width_deg / 2;
        beam.height_m = line.over(outline.arc_m, elevation_deg).height_m;
        if (std::isnan(beam.height_m)) continue;  // the beam of this radial never passes here
        beam.lower_edge_m = line.over(outline.arc_m, elevation_deg - half_deg).height_m;
        beam.upper_edge_m = line.over(outline.arc_m, elevation_deg + half_deg).height_m;
        beam.rise_m_per_deg = rise_of(beam, range_m, half_deg);
        beams_.push_back(std::move(beam));
    }
    put_in_order();
}

// Returns the rise per degree, computed from the edges that are on the right side of the beam's
// center. If neither edge is, returns the width of a degree at this range.
double OracleColumn::rise_of(const Beam& beam, double range_m, double half_deg) {
    const bool has_lower = std::islessequal(beam.lower_edge_m, beam.height_m);
    const bool has_upper = std::isgreaterequal(beam.upper_edge_m, beam.height_m);
    const double down_m_per_deg = (beam.height_m - beam.lower_edge_m) / half_deg;
    const double up_m_per_deg = (beam.upper_edge_m - beam.height_m) / half_deg;
    if (has_lower && has_upper) return (down_m_per_deg + up_m_per_deg) / 2;
    if (has_lower) return down_m_per_deg;
    if (has_upper) return up_m_per_deg;
    return range_m * static_cast<double>(degree);
}

// Sorts the beams by height. They may be out of order because radials may be measured off their
// sweeps' elevations. A lost cut keeps its position in the order.
void OracleColumn::put_in_order() {
    std::vector<bool> adjacent;
    for (const Beam& beam : beams_)
        adjacent.push_back(beam.adjacent_to_next);
    std::stable_sort(beams_.begin(), beams_.end(),
                     [](const Beam& a, const Beam& b) { return a.height_m < b.height_m; });
    for (std::size_t i = 0; i < beams_.size(); ++i) {
        beams_[i].adjacent_to_next = adjacent[i];
        const bool equal = i > 0 && beams_[i].height_m - beams_[i - 1].height_m < doubt_height_m;
        if (equal) doubtful_ = true;
    }
}

std::vector<OracleColumn::Share> OracleColumn::by_pattern(std::size_t nearest, double height_m,
                                                          double width_deg) const {
    std::size_t first = nearest;
    while (first > 0 && beams_[first - 1].adjacent_to_next)
        --first;
    std::vector<Share> shares;
    double total = 0;
    for (std::size_t at = first; at < beams_.size(); ++at) {
        const double weight =
            oracle_pattern((height_m - beams_[at].height_m) / beams_[at].rise_m_per_deg, width_deg);
        if (weight > 0) shares.emplace_back(&beams_[at], weight);
        total += weight;
        if (!beams_[at].adjacent_to_next) break;
    }
    if (!(total > 0)) return {{&beams_[nearest], 1}};
    for (Share& share : shares)
        share.second /= total;
    return shares;
}

std::vector<OracleColumn::Share> OracleColumn::beams_at(double height_m) const {
    std::size_t above = 0;
    while (above < beams_.size() && std::islessequal(beams_[above].height_m, height_m))
        ++above;
    const bool has_below = above > 0;
    const bool has_above = above < beams_.size();
    const bool by_beam = setting_.method.interpolation == Interpolation::beam_weighted;
    if (has_below && has_above && beams_[above - 1].adjacent_to_next) {
        const Beam& low = beams_[above - 1];
        const Beam& high = beams_[above];
        const double share = (height_m - low.height_m) / (high.height_m - low.height_m);
        if (setting_.method.interpolation == Interpolation::nearest) {
            return {{share > 0.5 ? &high : &low, 1}};
        }
        if (!by_beam) return {{&low, 1 - share}, {&high, share}};
        const double mean_rise = (low.rise_m_per_deg + high.rise_m_per_deg) / 2;
        const double spacing_deg = (high.height_m - low.height_m) / mean_rise;
        return by_pattern(share > 0.5 ? above : above - 1, height_m,
                          std::max(setting_.beam_width_deg, spacing_deg));
    }
    // The height of an edge that never passes over the column is NaN.
    const bool in_below = has_below && std::islessequal(height_m, beams_[above - 1].upper_edge_m);
    const bool in_above = has_above && std::isgreaterequal(height_m, beams_[above].lower_edge_m);
    if (!in_below && !in_above) return {};
    const bool take_below = in_below && (!in_above || height_m - beams_[above - 1].height_m <=
                                                          beams_[above].height_m - height_m);
    const std::size_t at = take_below ? above - 1 : above;
    if (by_beam) return by_pattern(at, height_m, setting_.beam_width_deg);
    return {{&beams_[at], 1}};
}

OracleCell OracleColumn::cell(std::size_t level, double raised_m) const {
    std::vector<double> heights_m;
    const double level_m = levels_m_[level];
    if (setting_.method.cell == CellExtent::point || levels_m_.size() == 1) {
        heights_m = {level_m + raised_m};
    } else {
        const std::size_t last = levels_m_.size() - 1;
        const double down_m = level > 0 ? level_m - levels_m_[level - 1] : levels_m_[1] - level_m;
        const double up_m =
            level < last ? levels_m_[level + 1] - level_m : level_m - levels_m_[last - 1];
        for (int i = 0; i < parts_of_a_level; ++i) {
            const double part = (i + 0.5) / parts_of_a_level;
            heights_m.push_back(level_m - down_m / 2 + part * (down_m + up_m) / 2 + raised_m);
        }
    }
    std::vector<WeightedGate> gates;
    for (const double height_m : heights_m) {
        const auto whole = static_cast<double>(heights_m.size());
        const std::vector<Share> shares = beams_at(height_m);
        if (shares.empty()) gates.push_back({CellStatus::not_seen, 0, 0, 0, 1 / whole});
        for (const auto& [beam, share] : shares) {
            for (WeightedGate gate : beam->gates) {
                gate.weight *= share / whole;
                gates.push_back(gate);
            }
        }
    }
    return decide(gates);
}

OracleCell OracleColumn::decide(const std::vector<WeightedGate>& gates) const {
    std::array<double, cell_status_count> weight{};
    for (const WeightedGate& gate : gates)
        weight[static_cast<std::size_t>(gate.status)] += gate.weight;
    const auto [u, n, folded, v, unavailable, ambiguous] = weight;
    const double f = folded + ambiguous;
    OracleCell cell{.unseen = u, .margin = std::abs(u - 0.5)};
    if (u > 0.5) return cell;
    cell.margin = std::min({cell.margin, std::abs(f - std::max(v, n))});
    if (f > v && f > n) {
        if (ambiguous > 0) cell.margin = std::min(cell.margin, std::abs(folded - ambiguous));
        cell.status = folded >= ambiguous ? CellStatus::range_folded : CellStatus::ambiguous;
        return cell;
    }
    cell.margin = std::min(cell.margin, std::abs(v - n));
    cell.status = v < n ? CellStatus::no_echo : CellStatus::value;
    if (cell.status != CellStatus::value) return cell;

    const Blending blending = blending_of(setting_.moment);
    const WeightedGate* heaviest = nullptr;
    for (const WeightedGate& gate : gates) {
        const bool heavier = heaviest == nullptr || gate.weight > heaviest->weight;
        if (gate.status == CellStatus::value && heavier) heaviest = &gate;
    }
    double sum = 0;
    double total = 0;
    const bool in_z = setting_.method.averaging == Averaging::in_z;
    for (const WeightedGate& gate : gates) {
        const bool has_value = gate.status == CellStatus::value;
        const bool has_limit =
            gate.status == CellStatus::no_echo && blending == Blending::with_detection_limit;
        if (!has_value && !has_limit) continue;
        double value = has_value ? gate.value : gate.limit_dbz;
        if (in_z) value = std::pow(10.0, value / 10);
        if (is_circular(blending)) {
            const double half = heaviest->half_period;
            const bool comparable = half > 0 && gate.half_period == half;
            if (!comparable) {
                if (gate.value != heaviest->value) cell.wide_on_circle = true;
                continue;
            }
            value = heaviest->value + std::remainder(value - heaviest->value, 2 * half);
            if (std::abs(value - heaviest->value) > half / 4) cell.wide_on_circle = true;
        }
        sum += gate.weight * value;
        total += gate.weight;
    }
    if (!(total > 0)) {
        cell.value = heaviest->value;
        return cell;
    }
    cell.value = sum / total;
    if (in_z) cell.value = 10 * std::log10(cell.value);
    if (is_circular(blending)) {
        const double half = heaviest->half_period;
        const double middle = blending == Blending::phase_circle ? half : 0;
        cell.value = middle + std::remainder(cell.value - middle, 2 * half);
    }
    return cell;
}

}  // namespace stormcellar::grid
