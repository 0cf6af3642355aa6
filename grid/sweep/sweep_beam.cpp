#include "grid/sweep/sweep_beam.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"

namespace stormcellar::grid {
namespace {

// Height for a beam that never passes over an arc. It is so large that the line to it from the
// previous arc is above all heights that matter.
constexpr float above_everything_m = 1e30F;

// Both return true if an edge is on the wrong side of the beam's center, or is NaN because the edge
// never passes over the arc.
bool is_lost_lower(double edge_m, double center_m) {
    return std::isnan(edge_m) || edge_m > center_m;
}
bool is_lost_upper(double edge_m, double center_m) {
    return std::isnan(edge_m) || edge_m < center_m;
}

}  // namespace

// Fills the table with the heights of the beam's center and edges at each step along the arc. Only
// this loop calls the beam model. Samples are interpolated in the table.
SweepBeam::SweepBeam(const BeamModel& beam, double elevation_deg, double half_beam_deg,
                     std::size_t table_size, const ArcTable* gates)
    : halves_per_deg_(static_cast<float>(1 / half_beam_deg)) {
    const BeamPath center = beam.path(elevation_deg);
    const BeamPath lower = beam.path(elevation_deg - half_beam_deg);
    const BeamPath upper = beam.path(elevation_deg + half_beam_deg);
    table_.reserve(table_size);
    lost_edges_.assign(table_size, 0);
    for (std::size_t i = 0; i < table_size; ++i) {
        const double arc_m = ArcTable::step_m * static_cast<double>(i);
        const float gate_and_half = gates == nullptr ? 0.0F : (*gates)[i];
        const auto [range_m, height_m] = center.over(arc_m);
        if (std::isnan(height_m)) {
            table_.push_back(
                {above_everything_m, above_everything_m, above_everything_m, gate_and_half});
            continue;
        }
        double lower_m = lower.over(arc_m).height_m;
        double upper_m = upper.over(arc_m).height_m;
        const bool no_lower = is_lost_lower(lower_m, height_m);
        const bool no_upper = is_lost_upper(upper_m, height_m);
        // A lost edge mirrors the other edge. If both are lost, use half the beam width at this
        // range.
        if (no_upper) {
            const double free_m = range_m * half_beam_deg * degree;
            upper_m = height_m + (no_lower ? free_m : height_m - lower_m);
        }
        if (no_lower) lower_m = height_m - (upper_m - height_m);
        lost_edges_[i] =
            static_cast<std::uint8_t>((no_lower ? lost_lower : 0) | (no_upper ? lost_upper : 0));
        table_.push_back({static_cast<float>(height_m), static_cast<float>(lower_m),
                          static_cast<float>(upper_m), gate_and_half});
    }
    const bool none = std::all_of(lost_edges_.begin(), lost_edges_.end(),
                                  [](std::uint8_t lost) { return lost == 0; });
    if (none) lost_edges_.clear();
}

}  // namespace stormcellar::grid
