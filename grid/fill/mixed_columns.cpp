#include "grid/fill/mixed_columns.h"

#include <cmath>
#include <numbers>

#include "grid/fill/beam_mixture.h"

namespace stormcellar::grid {
namespace {

constexpr float degree = std::numbers::pi_v<float> / 180;

// Returns the largest distance from the center of a cell to its corner, for the cells of the tile.
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

// Makes a mixture of gates for each sweep. Then MixedColumn combines the sweeps at each level.
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
    BeamMixture beam = beam_over(sweep, work_.method, column.azimuth_deg, column.place);
    beam.adjacent_to_next = planned.adjacent_to_next;
    if (planned.sampled) {
        beam.mixture = mixture_over(sweep, work_.method, work_.stack.beam_width_deg,
                                    column.azimuth_deg, column.place, footprint);
    } else {
        beam.mixture.add({planned.status, 0, 0, 0}, 1, work_.blending);
    }
    return beam;
}

CellResult MixedColumns::cell_at(std::size_t first, std::size_t count) {
    if (count == 1) return mixed_.cell_at(work_.heights_m[first]);
    return mixed_.mean_at(std::span(work_.heights_m).subspan(first, count));
}

}  // namespace stormcellar::grid
