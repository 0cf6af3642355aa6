#include "grid/sweep/sweep_mixture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "grid/beam/beam_pattern.h"

namespace stormcellar::grid {
namespace {

constexpr float degree = std::numbers::pi_v<float> / 180;

// Narrows [from, to] to the interval in which |at_zero + slope * t| is at most one half.
void narrow(float at_zero, float slope, float& from, float& to) {
    if (slope == 0) {
        if (!(std::abs(at_zero) <= 0.5F)) to = from - 1;
        return;
    }
    const float one = (-0.5F - at_zero) / slope;
    const float other = (0.5F - at_zero) / slope;
    from = std::max(from, std::min(one, other));
    to = std::min(to, std::max(one, other));
}

}  // namespace

Mixture nearest_gate(const PolarSweep& sweep, float azimuth_deg, ArcPlace place) {
    Mixture mixture;
    mixture.add(sweep.sample(azimuth_deg, place), 1, sweep.gates().blending());
    return mixture;
}

Mixture four_gates(const PolarSweep& sweep, float azimuth_deg, ArcPlace place) {
    const AzimuthTable::Bracket radials = sweep.azimuths().bracket(azimuth_deg);
    if (radials.nearest == AzimuthTable::none) return Mixture::of_unseen();
    Mixture mixture;
    sweep.gates().add_along_radial(radials.nearest, place, 1 - radials.other_weight, mixture);
    if (radials.other != AzimuthTable::none) {
        sweep.gates().add_along_radial(radials.other, place, radials.other_weight, mixture);
    }
    return mixture;
}

Mixture gates_by_pattern(const PolarSweep& sweep, float azimuth_deg, ArcPlace place,
                         float beam_width_deg) {
    const float width_deg = std::max(beam_width_deg, sweep.azimuths().spacing_deg());
    struct Weighted {
        int position;
        float weight;
    };
    // Radials are at least 0.2 degrees apart. So if more radials than this are within reach, the
    // data are damaged, and the further radials do not count.
    std::array<Weighted, 32> radials{};
    std::size_t count = 0;
    float total = 0;
    // The pattern depends only on the azimuth, so evaluate it once for each radial. The weights are
    // scaled to a sum of 1 below.
    sweep.azimuths().visit(azimuth_deg, width_deg, [&](int position, float offset_deg) {
        const float weight = beam_pattern(offset_deg, width_deg);
        if (count == radials.size() || !(weight > 0 || count == 0)) return;
        radials[count++] = {position, weight};
        total += weight;
    });
    if (count == 0) return Mixture::of_unseen();
    Mixture mixture;
    // If the pattern is 0 at all radials, only the first radial counts, which is the nearest.
    if (!(total > 0)) {
        sweep.gates().add_along_radial(radials[0].position, place, 1, mixture);
        return mixture;
    }
    for (std::size_t i = 0; i < count; ++i)
        sweep.gates().add_along_radial(radials[i].position, place, radials[i].weight / total,
                                       mixture);
    return mixture;
}

Mixture gates_inside(const PolarSweep& sweep, const Footprint& footprint, ArcPlace place) {
    // The outline is a parallelogram inside a circle. Seen from the site, the circle covers the
    // azimuths within asin(radius / arc) of its center, or all azimuths if the site is inside it.
    const float reach_deg = footprint.arc_m > footprint.radius_m
                                ? std::asin(footprint.radius_m / footprint.arc_m) / degree
                                : 180;
    const Blending blending = sweep.gates().blending();
    Mixture gates;
    Mixture beyond;
    // For values that wrap, take differences from the gate at the center.
    if (is_circular(blending)) {
        const Sample center = sweep.sample(footprint.azimuth_deg, place);
        if (center.status == CellStatus::value) gates.refer_to(center);
    }
    const float gates_a_m_of_arc = sweep.gates().gates_per_m_of_arc(place);
    if (!(gates_a_m_of_arc > 0)) return gates;
    sweep.azimuths().visit_all(footprint.azimuth_deg, reach_deg, [&](int position, float turn_deg) {
        const SweepGates::GatePlace at = sweep.gates().gate_place(position, place);
        if (at.end == 0) return;
        const float sine = std::sin(turn_deg * degree);
        const float cosine = std::cos(turn_deg * degree);
        // Along this radial, the coordinates u and v of the outline are linear in the arc. So |u|
        // <= 1/2 and |v| <= 1/2 each limit the arcs to an interval.
        float from_m = std::max(0.0F, footprint.arc_m - footprint.radius_m);
        float to_m = footprint.arc_m + footprint.radius_m;
        narrow(-footprint.u_along * footprint.arc_m,
               footprint.u_along * cosine + footprint.u_across * sine, from_m, to_m);
        narrow(-footprint.v_along * footprint.arc_m,
               footprint.v_along * cosine + footprint.v_across * sine, from_m, to_m);
        if (!(from_m <= to_m)) return;
        // Turn the interval of arcs into a run of gates. Gates beyond the last count as not seen.
        const float center = at.number_and_half - 0.5F;
        const float low = center + (from_m - footprint.arc_m) * gates_a_m_of_arc;
        const float high = center + (to_m - footprint.arc_m) * gates_a_m_of_arc;
        const auto first = std::max(at.first, static_cast<std::int32_t>(std::ceil(low)));
        const auto last = static_cast<std::int32_t>(std::floor(high));
        sweep.gates().add_gates(position, first, last < at.end ? last + 1 : at.end, gates);
        if (last >= at.end)
            beyond.add_unseen(static_cast<float>(last - std::max(first, at.end) + 1));
    });
    // Scale the weights to a sum of 1. The part of the circle that is in azimuth gaps is not seen.
    const float count = gates.weight() + beyond.weight();
    if (count == 0) return {};
    const bool gaps = sweep.azimuths().has_gaps() && reach_deg < 180;
    const auto share = gaps ? static_cast<float>(sweep.azimuths().seen_share(
                                  static_cast<double>(footprint.azimuth_deg - reach_deg),
                                  static_cast<double>(2 * reach_deg)))
                            : 1;
    Mixture mixture;
    mixture.add(gates, share / count, blending);
    mixture.add(beyond, share / count, blending);
    if (share < 1) mixture.add_unseen(1 - share);
    return mixture;
}

}  // namespace stormcellar::grid
