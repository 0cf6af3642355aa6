#include "grid/fill/mixed_columns.h"

#include <cmath>
#include <numbers>

#include "grid/sweep/sweep_mixture.h"

namespace stormcellar::grid {
namespace {

constexpr float degree = std::numbers::pi_v<float> / 180;

// Returns the largest distance of a corner from the center of its cell, over all cells of the tile.
float farthest_corner_m(const ColumnGeometry& geometry, const Tile& tile) {
    float radius_m = 0;
    for (int iy = tile.first_y; iy < tile.end_y; ++iy) {
        for (int ix = tile.first_x; ix < tile.end_x; ++ix)
            radius_m = std::max(radius_m, footprint_of(geometry, ix, iy).radius_m);
    }
    return radius_m;
}

}  // namespace

SampleReach MixedColumns::reach_over(const Tile& tile) const {
    SampleReach reach = work_.reach;
    if (work_.method.cell == CellExtent::area) {
        const float radius_m = farthest_corner_m(work_.geometry, tile);
        const bool is_far = tile.bounds.least_arc_m > radius_m;
        reach.arc_m += radius_m;
        reach.azimuth_deg += is_far ? std::asin(radius_m / tile.bounds.least_arc_m) / degree : 360;
    }
    return reach;
}

void MixedColumns::fill(std::span<const PlannedSweep> plan, std::span<const TileColumn> columns) {
    for (const TileColumn& column : columns)
        fill(plan, column);
}

// Makes a mixture of gates for each sweep, then lets MixedColumn combine the sweeps at each level.
void MixedColumns::fill(std::span<const PlannedSweep> plan, const TileColumn& column) {
    beams_.clear();
    const bool area = work_.method.cell == CellExtent::area;
    const Footprint footprint =
        area ? footprint_of(work_.geometry, column.ix, column.iy) : Footprint{};
    bool all_unseen = true;
    for (const PlannedSweep& planned : plan) {
        const BeamMixture beam = beam_of(planned, column, area ? &footprint : nullptr);
        if (!(beam.height_m < highest_beam_m)) continue;
        all_unseen = all_unseen && beam.mixture.is_all_unseen();
        beams_.push_back(beam);
    }
    if (all_unseen) return;
    put_in_order(std::span(beams_));
    mixed_.start(beams_);
    const std::span status = status_of(work_, column);
    const std::span values = values_of(work_, column);
    const std::size_t heights_a_level = work_.heights_m.size() / work_.levels.size();
    for (std::size_t level = 0; level < work_.levels.size(); ++level) {
        const CellResult cell = cell_at(level * heights_a_level, heights_a_level);
        status[level] = cell.status;
        if (cell.status == CellStatus::value) values[level] = cell.value;
    }
}

BeamMixture MixedColumns::beam_of(const PlannedSweep& planned, const TileColumn& column,
                                  const Footprint* footprint) const {
    const PolarSweep& sweep = work_.stack.sweeps[planned.index];
    PolarSweep::BeamHeights heights = sweep.heights(column.place);
    if (work_.method.radial_elevations) {
        const int position = sweep.radial_at(column.azimuth_deg);
        if (position != AzimuthTable::none)
            heights = sweep.offset(heights, sweep.elevation_offset_deg(position));
    }
    BeamMixture beam;
    beam.mixture = mixture_of(sweep, planned, column, footprint);
    beam.rise_m_per_deg = sweep.rise_m_per_deg(heights);
    heights = sweep.without_lost_edges(column.place, heights);
    beam.height_m = heights.center_m;
    beam.lower_edge_m = heights.lower_m;
    beam.upper_edge_m = heights.upper_m;
    beam.adjacent_to_next = planned.adjacent_to_next;
    return beam;
}

// A sweep that the plan found uniform needs no gates. If the outline of the cell holds no gate's
// center, as close to the site, the gates around the cell's center are used instead.
Mixture MixedColumns::mixture_of(const PolarSweep& sweep, const PlannedSweep& planned,
                                 const TileColumn& column, const Footprint* footprint) const {
    if (!planned.sampled) {
        Mixture uniform;
        uniform.add({planned.status, 0, 0, 0}, 1, work_.blending);
        return uniform;
    }
    if (footprint != nullptr) {
        const Mixture inside = gates_inside(sweep, *footprint, column.place);
        if (inside.weight() > 0) return inside;
    }
    switch (work_.method.interpolation) {
        case Interpolation::eight_point:
            return four_gates(sweep, column.azimuth_deg, column.place);
        case Interpolation::beam_weighted:
            return gates_by_pattern(sweep, column.azimuth_deg, column.place,
                                    work_.stack.beam_width_deg);
        case Interpolation::nearest:
        case Interpolation::linear:
            break;
    }
    return nearest_gate(sweep, column.azimuth_deg, column.place);
}

CellResult MixedColumns::cell_at(std::size_t first, std::size_t count) {
    if (count == 1) return mixed_.cell_at(work_.heights_m[first]);
    return mixed_.mean_at(std::span(work_.heights_m).subspan(first, count));
}

}  // namespace stormcellar::grid
