// retrieve/dealias/ambiguity.h -- which fold numbers are guesses.
//
// A fold number is a guess if another one would cost little more. What can be wrong as one is asked
// about as one: a node alone, nodes that firm edges hold together, and whole components.
//
// Accuracy  tests/retrieve/dealias_test.cpp counts wrong gates that are not marked.
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
