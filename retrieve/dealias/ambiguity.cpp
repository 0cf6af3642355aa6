#include "retrieve/dealias/ambiguity.h"

#include <algorithm>

#include "retrieve/dealias/offset_sets.h"

namespace stormcellar::retrieve {
namespace {

std::size_t at(std::int32_t index) {
    return static_cast<std::size_t>(index);
}

// A group is a guess if moving it by one raises the cost by at most this share of the votes about
// it.
constexpr float least_margin = 0.2F;
// An edge is firm if the votes for the solution have at least this share of all its votes, and at
// least this weight.
constexpr float firm_share = 0.9F, firm_weight = 2;

struct Margin {
    float up = 0, down = 0;  // by how much the cost rises if the group moves by one
    float votes = 0;
};

// Marks the nodes of each group whose margin is small, and of groups without votes.
void mark(const FoldGraph& graph, const std::vector<Votes>& anchors,
          const std::vector<std::int32_t>& folds, const std::vector<std::int32_t>& group,
          std::vector<std::uint8_t>& guessed) {
    std::vector<Margin> margins(at(graph.nodes));
    for (const FoldEdge& edge : graph.edges) {
        Margin& a = margins[at(group[at(edge.a)])];
        Margin& b = margins[at(group[at(edge.b)])];
        if (&a == &b) continue;
        const int number = folds[at(edge.b)] - folds[at(edge.a)];
        const float now = edge.votes.cost(number), votes = edge.votes.total();
        const float more = edge.votes.cost(number + 1) - now;
        const float less = edge.votes.cost(number - 1) - now;
        a.up += less;
        a.down += more;
        b.up += more;
        b.down += less;
        a.votes += votes;
        b.votes += votes;
    }
    for (std::size_t node = 0; node < anchors.size(); ++node) {
        Margin& margin = margins[at(group[node])];
        const Votes& votes = anchors[node];
        const float now = votes.cost(folds[node]);
        margin.up += votes.cost(folds[node] + 1) - now;
        margin.down += votes.cost(folds[node] - 1) - now;
        margin.votes += votes.total();
    }
    for (std::size_t node = 0; node < guessed.size(); ++node) {
        const Margin& margin = margins[at(group[node])];
        if (std::min(margin.up, margin.down) <= least_margin * margin.votes) guessed[node] = 1;
    }
}

}  // namespace

std::vector<std::uint8_t> guessed_nodes(const FoldGraph& graph, const std::vector<Votes>& anchors,
                                        const std::vector<std::int32_t>& folds) {
    std::vector<std::uint8_t> guessed(at(graph.nodes), 0);
    OffsetSets alone(graph.nodes), firm(graph.nodes), connected(graph.nodes);
    for (const FoldEdge& edge : graph.edges) {
        connected.join(edge.a, edge.b, 0);
        const float agreeing = edge.votes.at(folds[at(edge.b)] - folds[at(edge.a)]);
        if (agreeing >= firm_weight && agreeing >= firm_share * edge.votes.total())
            firm.join(edge.a, edge.b, 0);
    }
    for (OffsetSets* sets : {&alone, &firm, &connected}) {
        if (sets == &connected && anchors.empty()) continue;
        std::vector<std::int32_t> group;
        group.reserve(guessed.size());
        for (std::int32_t node = 0; node < graph.nodes; ++node)
            group.push_back(sets->find(node).root);
        mark(graph, anchors, folds, group, guessed);
    }
    return guessed;
}

}  // namespace stormcellar::retrieve
