#include "retrieve/dealias/fold_graph.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "retrieve/dealias/minimum_cut.h"
#include "retrieve/dealias/offset_sets.h"

namespace stormcellar::retrieve {

void Votes::add_real(float real, float weight) {
    const float below = std::floor(std::clamp(real, -most - 1.0F, most + 1.0F));
    const float part = std::clamp(real - below, 0.0F, 1.0F);
    add(static_cast<int>(below), weight * (1 - part));
    add(static_cast<int>(below) + 1, weight * part);
}

void Votes::add_shifted(const Votes& other, int shift) {
    for (int number = -most; number <= most; ++number)
        if (const float weight = other.at(number); weight > 0) add(number + shift, weight);
}

float Votes::total() const {
    return std::accumulate(weights_.begin(), weights_.end(), 0.0F);
}

float Votes::cost(int number) const {
    float sum = 0;
    for (int voted = -most; voted <= most; ++voted)
        sum += weights_[index(voted)] * static_cast<float>(std::abs(number - voted));
    return sum;
}

float Votes::rise(int number) const {
    float below = 0;
    const int last = std::clamp(number, -most - 1, most);
    for (int voted = -most; voted <= last; ++voted)
        below += weights_[index(voted)];
    return 2 * below - total();
}

int Votes::winner() const {
    return static_cast<int>(std::ranges::max_element(weights_) - weights_.begin()) - most;
}

namespace {

// Limits the looks at arcs, because noise can have so many nearly equal solutions that finding the
// best takes minutes. Sweeps of real weather take up to 4 million looks.
constexpr std::int64_t most_looks = 8'000'000;
// A move that lowers the cost by a smaller share is the last in its direction.
constexpr double least_gain = 3e-3;

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

FoldEdge turned(const FoldEdge& edge) {
    FoldEdge other{edge.b, edge.a, {}};
    for (int number = -Votes::most; number <= Votes::most; ++number)
        other.votes.add(-number, edge.votes.at(number));
    return other;
}

// Returns the edges between nodes of different sets as edges between the sets' new nodes. Their
// votes are for the difference between the roots of the sets.
std::vector<FoldEdge> edges_between(const std::vector<FoldEdge>& edges, OffsetSets& sets,
                                    const std::vector<std::int32_t>& node_of_root) {
    std::vector<FoldEdge> between;
    between.reserve(edges.size());
    for (const FoldEdge& edge : edges) {
        const auto a = sets.find(edge.a);
        const auto b = sets.find(edge.b);
        if (a.root == b.root) continue;
        FoldEdge moved{node_of_root[at(a.root)], node_of_root[at(b.root)], {}};
        moved.votes.add_shifted(edge.votes, a.offset - b.offset);
        between.push_back(moved);
    }
    return between;
}

// Joins the two nodes of an edge if the winner of the edge weighs at least as much as all other
// votes about one of the nodes. Returns the number of joins.
std::int32_t join_over_heavy_edges(const std::vector<FoldEdge>& edges,
                                   const std::vector<float>& anchor_bound, OffsetSets& sets) {
    std::vector<float> total = anchor_bound;
    for (const FoldEdge& edge : edges) {
        const float weight = edge.votes.total();
        total[at(edge.a)] += weight;
        total[at(edge.b)] += weight;
    }
    std::int32_t joins = 0;
    for (const FoldEdge& edge : edges) {
        const int number = edge.votes.winner();
        const float weight = 2 * edge.votes.at(number);
        if (weight < total[at(edge.a)] && weight < total[at(edge.b)]) continue;
        if (sets.join(edge.a, edge.b, number)) ++joins;
    }
    return joins;
}

void find_components(FoldGraph& graph) {
    OffsetSets sets(graph.nodes);
    for (const FoldEdge& edge : graph.edges)
        sets.join(edge.a, edge.b, 0);
    graph.component.assign(at(graph.nodes), -1);
    std::vector<std::int32_t> of_root(at(graph.nodes), -1);
    for (std::int32_t node = 0; node < graph.nodes; ++node) {
        auto& component = of_root[at(sets.find(node).root)];
        if (component < 0) component = graph.components++;
        graph.component[at(node)] = component;
    }
}

// Lowers the cost of a solution.
class CostDescent {
  public:
    CostDescent(const FoldGraph& graph, const std::vector<Votes>& anchors,
                std::vector<std::int32_t>& folds)
        : graph_(graph),
          anchors_(anchors),
          folds_(folds),
          of_edge_(graph.edges.size()),
          of_anchor_(anchors.size()) {
        for (std::size_t i = 0; i < of_edge_.size(); ++i) {
            look_at_edge(i);
            const FoldEdge& edge = graph.edges[i];
            cost_ += static_cast<double>(edge.votes.cost(folds_[at(edge.b)] - folds_[at(edge.a)]));
        }
        for (std::size_t node = 0; node < of_anchor_.size(); ++node)
            look_at_anchor(node);
    }

    // Adds `step` to the folds of the set of nodes for which this lowers the cost most. Returns
    // false if it lowers the cost for no set. The change of the cost is a sum over the nodes of the
    // set, and over the edges from the set to other nodes, so a minimum cut finds the set. The set
    // is on the source's side.
    bool move(std::int32_t step, std::int64_t& looks) {
        MinimumCut cut(graph_.nodes, of_edge_.size());
        for (std::size_t i = 0; i < of_edge_.size(); ++i) {
            const FoldEdge& edge = graph_.edges[i];
            const auto [a_alone, b_alone] = costs_alone(i, step);
            // If both move, the cost stays. A node that gains by moving alone prefers to move, and
            // takes its gain back from a neighbor that moves with it.
            const float gain = std::max(-a_alone, 0.0F) - std::max(-b_alone, 0.0F);
            cut.prefer_source(edge.a, gain);
            cut.prefer_source(edge.b, -gain);
            cut.connect(edge.a, edge.b, a_alone + gain, b_alone - gain);
        }
        for (std::size_t node = 0; node < of_anchor_.size(); ++node)
            cut.prefer_source(static_cast<std::int32_t>(node), -of_anchor_[node].by(step));
        looks -= cut.run(looks);
        const double change = change_of(cut, step);
        if (change > -least_change) return false;
        apply(cut, step);
        cost_ += change;
        return -change > least_gain * cost_;
    }

  private:
    // Requires a clear gain, so that rounding does not make two solutions of equal cost alternate
    // forever.
    static constexpr double least_change = 1e-4;
    // By how much the cost rises if a fold number, or a difference of two, changes by one.
    struct Rise {
        float up = 0, down = 0;
        [[nodiscard]] float by(std::int32_t step) const { return step > 0 ? up : down; }
    };
    struct Alone {
        float a, b;
    };

    void look_at_edge(std::size_t i) {
        const FoldEdge& edge = graph_.edges[i];
        const int number = folds_[at(edge.b)] - folds_[at(edge.a)];
        of_edge_[i] = {edge.votes.rise(number), -edge.votes.rise(number - 1)};
    }
    void look_at_anchor(std::size_t node) {
        const int number = folds_[node];
        of_anchor_[node] = {anchors_[node].rise(number), -anchors_[node].rise(number - 1)};
    }
    // Returns the changes of the cost if only one node of an edge moves.
    [[nodiscard]] Alone costs_alone(std::size_t i, std::int32_t step) const {
        return {of_edge_[i].by(-step), of_edge_[i].by(step)};
    }
    [[nodiscard]] double change_of(const MinimumCut& cut, std::int32_t step) const {
        double change = 0;
        for (std::size_t i = 0; i < of_edge_.size(); ++i) {
            const bool a_moves = cut.on_source_side(graph_.edges[i].a);
            if (a_moves == cut.on_source_side(graph_.edges[i].b)) continue;
            const auto [a_alone, b_alone] = costs_alone(i, step);
            change += static_cast<double>(a_moves ? a_alone : b_alone);
        }
        for (std::size_t node = 0; node < of_anchor_.size(); ++node)
            if (cut.on_source_side(static_cast<std::int32_t>(node)))
                change += static_cast<double>(of_anchor_[node].by(step));
        return change;
    }
    void apply(const MinimumCut& cut, std::int32_t step) {
        for (std::int32_t node = 0; node < graph_.nodes; ++node) {
            if (!cut.on_source_side(node)) continue;
            folds_[at(node)] += step;
            if (!of_anchor_.empty()) look_at_anchor(at(node));
        }
        for (std::size_t i = 0; i < of_edge_.size(); ++i) {
            const FoldEdge& edge = graph_.edges[i];
            if (cut.on_source_side(edge.a) != cut.on_source_side(edge.b)) look_at_edge(i);
        }
    }

    const FoldGraph& graph_;
    const std::vector<Votes>& anchors_;
    std::vector<std::int32_t>& folds_;
    std::vector<Rise> of_edge_, of_anchor_;
    double cost_ = 0;  // of the edges, and the changes by the moves
};

}  // namespace

// Sorts the edges by their region a with a counting sort. For each b, `place` is the index of the
// last combined edge that ends at b, so a later edge with the same a and b finds it.
void combine_edges(std::vector<FoldEdge>& edges, std::int32_t regions) {
    std::vector<std::size_t> begin(at(regions) + 1, 0);
    for (FoldEdge& edge : edges) {
        if (edge.a > edge.b) edge = turned(edge);
        if (edge.a != edge.b) ++begin[at(edge.a) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> order(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (edges[i].a != edges[i].b) order[next[at(edges[i].a)]++] = static_cast<std::uint32_t>(i);
    constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
    std::vector<std::size_t> place(at(regions), nowhere);
    std::vector<FoldEdge> combined;
    combined.reserve(order.size());
    for (std::int32_t a = 0; a < regions; ++a) {
        const std::size_t first = combined.size();
        for (std::size_t i = begin[at(a)]; i < begin[at(a) + 1]; ++i) {
            const FoldEdge& edge = edges[order[i]];
            std::size_t& known = place[at(edge.b)];
            if (known == nowhere || known < first) {
                known = combined.size();
                combined.push_back(edge);
                continue;
            }
            combined[known].votes.add_shifted(edge.votes, 0);
        }
    }
    edges = std::move(combined);
}

FoldGraph fold_graph(std::vector<FoldEdge> edges, std::int32_t regions,
                     const std::vector<float>& anchor_bound) {
    FoldGraph graph;
    graph.nodes = regions;
    graph.node_of_region.resize(at(regions));
    std::iota(graph.node_of_region.begin(), graph.node_of_region.end(), 0);
    graph.fold_in_node.assign(at(regions), 0);
    graph.edges = std::move(edges);
    combine_edges(graph.edges, regions);
    std::vector<float> bound = anchor_bound;
    while (true) {
        OffsetSets sets(graph.nodes);
        const std::int32_t joins = join_over_heavy_edges(graph.edges, bound, sets);
        if (joins == 0) break;
        std::vector<std::int32_t> node_of_root(at(graph.nodes), -1);
        std::int32_t nodes = 0;
        std::vector<float> next_bound;
        for (std::int32_t node = 0; node < graph.nodes; ++node) {
            auto& number = node_of_root[at(sets.find(node).root)];
            if (number < 0) {
                number = nodes++;
                next_bound.push_back(0);
            }
            next_bound[at(number)] += bound[at(node)];
        }
        for (std::int32_t region = 0; region < regions; ++region) {
            const auto found = sets.find(graph.node_of_region[at(region)]);
            graph.node_of_region[at(region)] = node_of_root[at(found.root)];
            graph.fold_in_node[at(region)] += found.offset;
        }
        graph.edges = edges_between(graph.edges, sets, node_of_root);
        graph.nodes = nodes;
        combine_edges(graph.edges, nodes);
        bound = std::move(next_bound);
        if (joins < nodes / 20) break;
    }
    find_components(graph);
    return graph;
}

std::vector<std::int32_t> likely_folds(const FoldGraph& graph) {
    struct Heavy {
        float weight;
        std::int32_t edge;
    };
    std::vector<Heavy> order;
    order.reserve(graph.edges.size());
    for (std::size_t i = 0; i < graph.edges.size(); ++i) {
        const Votes& votes = graph.edges[i].votes;
        order.push_back(
            {2 * votes.at(votes.winner()) - votes.total(), static_cast<std::int32_t>(i)});
    }
    std::ranges::stable_sort(order, std::greater<>{}, &Heavy::weight);
    OffsetSets sets(graph.nodes);
    for (const Heavy& heavy : order) {
        const FoldEdge& edge = graph.edges[at(heavy.edge)];
        sets.join(edge.a, edge.b, edge.votes.winner());
    }
    std::vector<std::int32_t> folds;
    folds.reserve(at(graph.nodes));
    for (std::int32_t node = 0; node < graph.nodes; ++node)
        folds.push_back(sets.find(node).offset);
    return folds;
}

void minimize_cost(const FoldGraph& graph, const std::vector<Votes>& anchors,
                   std::vector<std::int32_t>& folds) {
    // Move whole components first, which saves many cuts.
    if (!anchors.empty()) {
        std::vector<std::array<float, 2 * Votes::most + 1>> costs(at(graph.components));
        for (std::int32_t node = 0; node < graph.nodes; ++node)
            for (int shift = -Votes::most; shift <= Votes::most; ++shift)
                costs[at(graph.component[at(node)])][at(shift + Votes::most)] +=
                    anchors[at(node)].cost(folds[at(node)] + shift);
        for (std::int32_t node = 0; node < graph.nodes; ++node) {
            const auto& of = costs[at(graph.component[at(node)])];
            const auto least = std::ranges::min_element(of);
            // Leave a component without votes where it is.
            if (*least < of[at(Votes::most)])
                folds[at(node)] += static_cast<std::int32_t>(least - of.begin()) - Votes::most;
        }
    }
    std::int64_t looks = most_looks;
    int idle = 0;
    CostDescent descent(graph, anchors, folds);
    for (int i = 0; looks > 0 && idle < 2; ++i)
        idle = descent.move(i % 2 == 0 ? 1 : -1, looks) ? 0 : idle + 1;
}

}  // namespace stormcellar::retrieve
