// retrieve/dealias/anchors.h -- lets the wind at a region's height, and the sweeps above and below
// the region, vote for its fold number.
//
// Threads  Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/dealias/fold_graph.h"
#include "retrieve/dealias/regions.h"
#include "retrieve/dealias/velocity_sheet.h"
#include "retrieve/wind/folded_wind.h"

namespace stormcellar::retrieve {

// A sheet, and the results of the steps from its velocities to fold numbers.
struct SheetState {
    VelocitySheet sheet;
    SheetRegions regions;
    FoldGraph graph;
    std::vector<std::int32_t> folds;    // of each node
    std::vector<Votes> outer_anchors;   // of each node, from outside the volume's sweeps
    std::vector<std::uint8_t> guessed;  // of each node
    std::vector<float> heights_m;       // of each gate number, above the antenna
    // of each gate, radials x gates; fill_gate_folds() makes them from `folds`
    std::vector<std::int8_t> gate_folds;
    std::vector<std::uint8_t> ambiguous;  // 1 for each gate whose fold number is uncertain

    [[nodiscard]] std::int32_t fold_of(std::int32_t region) const {
        const auto r = static_cast<std::size_t>(region);
        return folds[static_cast<std::size_t>(graph.node_of_region[r])] + graph.fold_in_node[r];
    }
    void fill_gate_folds();
};

// Weights of the anchor votes for one gate. A pair of neighbors that agree votes with weight 1.
inline constexpr float wind_weight = 0.02F;     // where all gates agree with the wind
inline constexpr float neighbor_weight = 0.1F;  // at the same height

// The vote of a gate above or below loses a factor of e in this distance.
inline constexpr double height_of_decay_m = 1000;

// The largest weight that anchors can give to a gate.
inline constexpr float most_anchor_weight = wind_weight + 2 * neighbor_weight;

// Adds the votes of the wind for each gate of the sheet.
void anchor_to_wind(const FoldedWind& wind, const SheetState& state, std::vector<Votes>& anchors);

// Adds the votes of another sheet, whose gate_folds must be known. Each gate gets the vote of the
// gate of `other` above or below it, which weighs up to `weight` and less with distance.
void anchor_to_sheet(const SheetState& other, const SheetState& state, std::vector<Votes>& anchors,
                     float weight = neighbor_weight);

}  // namespace stormcellar::retrieve
