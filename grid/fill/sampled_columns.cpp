#include "grid/fill/sampled_columns.h"

#include <numeric>

namespace stormcellar::grid {

// Samples one sweep at all open columns of the tile. If the sweep is uniform over the tile, only
// the height of its beam must be computed.
template <bool radial_elevations, bool nearest, bool circular>
template <bool sampled>
void SampledColumns<radial_elevations, nearest, circular>::look_at(
    const PlannedSweep& planned, std::span<const TileColumn> columns) {
    const PolarSweep& sweep = work_.stack.sweeps[planned.index];
    const float top_m = work_.levels.top_m();
    std::size_t still_open = 0;
    for (const std::size_t at : open_) {
        const TileColumn& column = columns[at];
        const int position =
            sampled || radial_elevations ? sweep.radial_at(column.azimuth_deg) : AzimuthTable::none;
        const BeamAtArc over = sweep.beam().at(column.place);
        BeamHeights heights = over.heights;
        if (radial_elevations && position != AzimuthTable::none)
            heights = sweep.beam().offset(heights, sweep.gates().elevation_offset_deg(position));
        open_[still_open] = at;
        // If the sweeps are in order, all later sweeps pass still higher over this column. So the
        // column is finished.
        const bool above_top = heights.center_m > top_m && heights.center_m < highest_beam_m;
        still_open += above_top && work_.stack.in_order ? 0 : 1;
        if (!(heights.center_m < highest_beam_m)) continue;
        heights = sweep.beam().without_lost_edges(column.place, heights);
        BeamSample& beam = beams_[at * most_beams_ + beam_counts_[at]++];
        beam.sample =
            sampled ? sweep.sample(position, column.place, over) : Sample{planned.status, 0, 0, 0};
        beam.height_m = heights.center_m;
        beam.lower_edge_m = heights.lower_m;
        beam.upper_edge_m = heights.upper_m;
        beam.adjacent_to_next = planned.adjacent_to_next;
    }
    open_.resize(still_open);
}

template <bool radial_elevations, bool nearest, bool circular>
void SampledColumns<radial_elevations, nearest, circular>::fill(
    std::span<const PlannedSweep> plan, std::span<const TileColumn> columns) {
    most_beams_ = plan.size();
    beams_.resize(std::max(beams_.size(), columns.size() * most_beams_));
    beam_counts_.assign(columns.size(), 0);
    open_.resize(columns.size());
    std::iota(open_.begin(), open_.end(), std::size_t{0});
    for (const PlannedSweep& planned : plan) {
        if (open_.empty()) break;
        planned.sampled ? look_at<true>(planned, columns) : look_at<false>(planned, columns);
    }
    for (std::size_t at = 0; at < columns.size(); ++at) {
        const std::span beams = std::span(beams_).subspan(at * most_beams_, beam_counts_[at]);
        if (beams.empty()) continue;
        put_in_order(beams);
        fill_column_as<nearest, circular>(beams, work_.levels, work_.blending,
                                          status_of(work_, columns[at]),
                                          values_of(work_, columns[at]));
    }
}

template class SampledColumns<false, false, false>;
template class SampledColumns<false, false, true>;
template class SampledColumns<false, true, false>;
template class SampledColumns<false, true, true>;
template class SampledColumns<true, false, false>;
template class SampledColumns<true, false, true>;
template class SampledColumns<true, true, false>;
template class SampledColumns<true, true, true>;

}  // namespace stormcellar::grid
