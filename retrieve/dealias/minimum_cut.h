// retrieve/dealias/minimum_cut.h -- the minimum cut of a graph with a source and a sink.
//
// Two trees grow from the source and from the sink until they touch. The path between them is
// filled. Nodes that this cuts off from their tree are attached elsewhere in the tree, or freed, so
// that both trees are used again.
//
// Source   Boykov and Kolmogorov (2004), with the marks of distance of their section 3.2.4.
// Accuracy Costs are floats; a cut is the smallest up to 1e-5 of the largest cost.
// Threads  One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace stormcellar::retrieve {

class MinimumCut {
  public:
    MinimumCut(std::int32_t nodes, std::size_t most_connections)
        : nodes_(static_cast<std::size_t>(nodes)) {
        arcs_.reserve(2 * most_connections);
    }
    // Adds the cost of having the node on the sink's side. A negative cost is a cost of having it
    // on the source's side.
    void prefer_source(std::int32_t node, float cost);
    // Adds the cost of having `from` on the source's side and `to` on the sink's, and the cost of
    // the reverse.
    void connect(std::int32_t from, std::int32_t to, float cost, float reverse_cost);
    // Computes the cut, after which on_source_side() is valid. Stops after about this many looks at
    // arcs; the result is a cut then, but not the smallest. Returns the number of looks.
    std::int64_t run(std::int64_t most_looks);
    [[nodiscard]] bool on_source_side(std::int32_t node) const {
        return at(node).tree == Tree::source;
    }

  private:
    static constexpr std::int32_t none = -1, terminal = -2, orphan = -3;
    enum class Tree : std::uint8_t { free, source, sink };
    struct Node {
        std::int32_t first = none;   // arc
        std::int32_t parent = none;  // the arc to it, or terminal, orphan or none
        std::int32_t distance = 0;   // to the root, true at the time `checked`
        std::int32_t checked = 0;
        float rest = 0;  // capacity left from the source; negative: to the sink
        Tree tree = Tree::free;
        bool is_active = false;
    };
    struct Arc {
        std::int32_t to, next;
        float capacity;  // left
    };

    [[nodiscard]] Node& at(std::int32_t node) { return nodes_[static_cast<std::size_t>(node)]; }
    [[nodiscard]] const Node& at(std::int32_t node) const {
        return nodes_[static_cast<std::size_t>(node)];
    }
    [[nodiscard]] Arc& arc(std::int32_t index) { return arcs_[static_cast<std::size_t>(index)]; }
    // Capacity left along an arc of a node of the tree, away from the root.
    [[nodiscard]] float outward(Tree tree, std::int32_t index) {
        return arc(tree == Tree::source ? index : index ^ 1).capacity;
    }
    void activate(std::int32_t node);
    [[nodiscard]] std::int32_t grow(std::int32_t node);
    void fill(std::int32_t bridge);
    float least_along(std::int32_t node, float least);
    void fill_along(std::int32_t node, float flow);
    void make_orphan(std::int32_t node);
    void adopt();
    void adopt(std::int32_t node);
    [[nodiscard]] bool is_rooted(std::int32_t node, std::int32_t& distance);

    std::vector<Node> nodes_;
    std::vector<Arc> arcs_;  // an arc and its reverse are neighbors
    std::deque<std::int32_t> active_, orphans_;
    std::int32_t time_ = 0;
    std::int64_t looks_ = 0;
};

}  // namespace stormcellar::retrieve
