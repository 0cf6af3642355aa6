// retrieve/dealias/fold_graph.h -- chooses fold numbers for regions, so that as few neighbors as
// possible contradict them.
//
// Each pair of neighboring gates votes for the difference of their regions' fold numbers, with a
// weight. An anchor votes for the fold number of one region. The cost of a solution is the sum over
// all votes of weight x |difference chosen - difference voted for|. It is convex, so its minimum is
// found exactly, by minimum cuts that each raise or lower a set of regions by one.
//
// Source    Bioucas-Dias and Valadao (2007), phase unwrapping via graph cuts (PUMA); Dinic (1970).
// Accuracy  The minimum of the cost, up to 1e-5 of its weights; tests/retrieve/fold_graph_test.cpp
//           compares with all solutions of small graphs.
// Threads   Pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace stormcellar::retrieve {

// Votes for whole numbers from -most to most; votes beyond count for the last number.
class Votes {
  public:
    static constexpr int most = 7;
    void add(int number, float weight) { weights_[index(number)] += weight; }
    // Splits the vote for a number that need not be whole, such that the cost at whole numbers is
    // weight x |number - real|.
    void add_real(float real, float weight);
    // Adds all votes of `other`, each for a number that is `shift` higher.
    void add_shifted(const Votes& other, int shift);
    [[nodiscard]] float at(int number) const {
        return number < -most || number > most ? 0 : weights_[index(number)];
    }
    [[nodiscard]] float total() const;
    [[nodiscard]] float cost(int number) const;
    // The number with the largest weight.
    [[nodiscard]] int winner() const;

  private:
    static std::size_t index(int number) {
        return static_cast<std::size_t>(std::clamp(number, -most, most) + most);
    }
    std::array<float, 2 * most + 1> weights_{};
};

// Votes for fold(b) - fold(a).
struct FoldEdge {
    std::int32_t a = 0, b = 0;
    Votes votes;
};

// The weight of a vote by a jump that is this far from a whole number of turns, which is half a
// turn at most: 1 for an exact one, 0.1 for one that says nearly nothing.
[[nodiscard]] inline float vote_weight(float from_whole) {
    return 1 - 1.8F * (from_whole < 0 ? -from_whole : from_whole);
}

// Joins the edges of each pair of regions into one with a < b; drops edges from a region to itself.
void combine_edges(std::vector<FoldEdge>& edges, std::int32_t regions);

// Regions that one solution has at fixed differences are one node.
struct FoldGraph {
    std::int32_t nodes = 0;
    std::vector<FoldEdge> edges;  // combined
    std::vector<std::int32_t> node_of_region;
    std::vector<std::int32_t> fold_in_node;  // fold(region) - fold(its node)
    std::vector<std::int32_t> component;     // of a node: nodes that edges connect
    std::int32_t components = 0;
};

// Joins a region to its neighbor wherever one vote outweighs all other votes about the region
// together with any anchor of up to anchor_bound[region]. So the minimum stays the same.
[[nodiscard]] FoldGraph fold_graph(std::vector<FoldEdge> edges, std::int32_t regions,
                                   const std::vector<float>& anchor_bound);

// Returns a first solution: the heaviest votes that do not contradict heavier ones.
[[nodiscard]] std::vector<std::int32_t> likely_folds(const FoldGraph& graph);

// Brings `folds` to the minimum. Without anchors, the fold number of each component is free.
void minimize_cost(const FoldGraph& graph, const std::vector<Votes>& anchors,
                   std::vector<std::int32_t>& folds);

[[nodiscard]] double cost_of(const FoldGraph& graph, const std::vector<Votes>& anchors,
                             const std::vector<std::int32_t>& folds);

}  // namespace stormcellar::retrieve
