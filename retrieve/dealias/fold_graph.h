// retrieve/dealias/fold_graph.h -- chooses fold numbers for regions, so that as few neighbors as
// possible contradict them.
//
// Each pair of neighboring gates votes for the difference of their regions' fold numbers, with a
// weight. An anchor votes for the fold number of one region. The cost of a solution is the sum over
// all votes of weight x |difference chosen - difference voted for|. The cost is convex, so minimum
// cuts, which each raise or lower a set of regions by one, lead to its minimum.
//
// Source    Bioucas-Dias and Valadao (2007), phase unwrapping via graph cuts (PUMA).
// Accuracy  tests/retrieve/fold_graph_test.cpp finds the minimum of small graphs to 1e-3. In noisy
//           data, minimize_cost() may stop before the minimum to bound its time.
// Threads   Pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace stormcellar::retrieve {

// Votes for whole numbers from -most to most. A vote for a number beyond these counts for the
// nearest of them.
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
    // Returns cost(number + 1) - cost(number).
    [[nodiscard]] float rise(int number) const;
    // Returns the number with the largest weight.
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

// Returns the weight of a vote by a jump. `from_whole` is the distance of the jump from a whole
// number of turns, at most half a turn. The weight is 1 at distance 0, and 0.1 at half a turn,
// where the jump says nearly nothing.
[[nodiscard]] inline float vote_weight(float from_whole) {
    return 1 - 1.8F * (from_whole < 0 ? -from_whole : from_whole);
}

// Returns the nearest whole number, quickly.
[[nodiscard]] inline float nearest_whole(float turns) {
    constexpr float first_without_parts = 12'582'912;  // 1.5 x 2^23, from which floats are whole
    return (turns + first_without_parts) - first_without_parts;
}

// Joins all edges between the same two regions into one edge with a < b, and drops edges from a
// region to itself.
void combine_edges(std::vector<FoldEdge>& edges, std::int32_t regions);

// The graph after regions were joined: a node is a set of regions whose fold numbers have fixed
// differences.
struct FoldGraph {
    std::int32_t nodes = 0;
    std::vector<FoldEdge> edges;  // combined
    std::vector<std::int32_t> node_of_region;
    std::vector<std::int32_t> fold_in_node;  // fold(region) - fold(its node)
    std::vector<std::int32_t> component;     // of each node: a set of nodes that edges connect
    std::int32_t components = 0;
};

// Makes a graph from edges between regions. Joins a region to a neighbor if the votes for one
// difference weigh at least as much as all other votes about the region together with its anchors,
// which weigh at most anchor_bound[region]. Such joins do not change the minimum of the cost.
[[nodiscard]] FoldGraph fold_graph(std::vector<FoldEdge> edges, std::int32_t regions,
                                   const std::vector<float>& anchor_bound);

// Returns a first solution, which follows the winner of each edge, the clearest winner first,
// unless edges that were followed earlier already fix the difference.
[[nodiscard]] std::vector<std::int32_t> likely_folds(const FoldGraph& graph);

// Changes `folds` until no set of nodes that moves by one lowers the cost, or a limit on the work
// is reached. Without anchors, a whole component can move at no cost.
void minimize_cost(const FoldGraph& graph, const std::vector<Votes>& anchors,
                   std::vector<std::int32_t>& folds);

}  // namespace stormcellar::retrieve
