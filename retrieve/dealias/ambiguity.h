// retrieve/dealias/ambiguity.h -- finds the fold numbers that are guesses.
//
// A fold number is a guess if a change of it by one would raise the cost (fold_graph.h) by little.
// Nodes can be wrong together. So the function changes single nodes, then groups of nodes that firm
// edges hold together, and, if there are anchors, whole components.
//
// Accuracy  Wrong gates may stay unmarked; Score::wrong_unmarked counts such gates in tests.
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/dealias/fold_graph.h"

namespace stormcellar::retrieve {

// Returns 1 for each node whose fold number is a guess.
[[nodiscard]] std::vector<std::uint8_t> guessed_nodes(const FoldGraph& graph,
                                                      const std::vector<Votes>& anchors,
                                                      const std::vector<std::int32_t>& folds);

}  // namespace stormcellar::retrieve
