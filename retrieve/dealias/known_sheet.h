// retrieve/dealias/known_sheet.h -- lets sweeps that were dealiased before vote for fold numbers:
// sweeps of an earlier volume, or earlier sweeps of a volume that still grows.
//
// Each gate gets the votes of the gates at its place in the two known sheets that are nearest in
// elevation and time. A vote weighs less, the farther away and the older its gate is. Known echo
// stays at its place and is not moved with the wind.
//
// Threads  Pure functions.
#pragma once

#include <span>
#include <vector>

#include "retrieve/dealias/anchors.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// The largest weight that known sheets can give to a gate, beside most_anchor_weight.
inline constexpr float most_known_weight = 2 * neighbor_weight;

// Returns the sheets of the VELD of all sweeps. Their fold numbers are 0, because the velocities
// are unfolded; ambiguous gates have no value.
[[nodiscard]] std::vector<SheetState> known_sheets(std::span<const level2::Sweep> dealiased);

// Adds the votes of the known sheets for each gate of the sheet. A known sheet that is more than 15
// minutes older or newer has no vote.
void anchor_to_known(std::span<const SheetState> known, const SheetState& state,
                     std::vector<Votes>& anchors);

}  // namespace stormcellar::retrieve
