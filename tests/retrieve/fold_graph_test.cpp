#include "retrieve/dealias/fold_graph.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

constexpr std::int32_t regions = 6;

struct Problem {
    std::vector<FoldEdge> edges;
    std::vector<Votes> anchors;
    std::vector<float> bound;
};

Problem random_problem(std::mt19937& random, bool is_anchored) {
    std::uniform_int_distribution<std::int32_t> region(0, regions - 1);
    std::uniform_int_distribution<int> number(-1, 1);
    std::uniform_real_distribution<float> weight(0.1F, 3), real(-2, 2);
    Problem problem;
    for (int i = 0; i < 12; ++i) {
        FoldEdge edge{region(random), region(random), {}};
        edge.votes.add(number(random), weight(random));
        problem.edges.push_back(edge);
    }
    problem.bound.assign(regions, 0);
    if (!is_anchored) return problem;
    problem.anchors.resize(regions);
    for (std::size_t i = 0; i < regions; ++i) {
        problem.anchors[i].add_real(real(random), weight(random));
        problem.bound[i] = problem.anchors[i].total();
    }
    return problem;
}

double cost(const Problem& problem, const std::vector<std::int32_t>& folds) {
    double sum = 0;
    for (const FoldEdge& edge : problem.edges) {
        if (edge.a == edge.b) continue;
        sum += static_cast<double>(edge.votes.cost(folds[static_cast<std::size_t>(edge.b)] -
                                                   folds[static_cast<std::size_t>(edge.a)]));
    }
    for (std::size_t i = 0; i < problem.anchors.size(); ++i)
        sum += static_cast<double>(problem.anchors[i].cost(folds[i]));
    return sum;
}

double least_cost(const Problem& problem) {
    std::vector<std::int32_t> folds(regions, -2);
    double least = cost(problem, folds);
    while (true) {
        std::size_t digit = 0;
        while (digit < regions && folds[digit] == 2)
            folds[digit++] = -2;
        if (digit == regions) return least;
        ++folds[digit];
        least = std::min(least, cost(problem, folds));
    }
}

// Returns the anchors of each node: the anchors of its regions, shifted by the regions' fold
// numbers within the node.
std::vector<Votes> anchors_of_nodes(const Problem& problem, const FoldGraph& graph) {
    std::vector<Votes> anchors(problem.anchors.empty() ? 0 : static_cast<std::size_t>(graph.nodes));
    for (std::size_t i = 0; i < problem.anchors.size(); ++i)
        anchors[static_cast<std::size_t>(graph.node_of_region[i])].add_shifted(
            problem.anchors[i], -graph.fold_in_node[i]);
    return anchors;
}

// Compares the result with all 5^6 solutions from -2 to 2.
TEST(FoldGraph, FindsTheLeastCostOfSmallGraphs) {
    std::mt19937 random(11);
    int joined = 0;
    for (int round = 0; round < 100; ++round) {
        const Problem problem = random_problem(random, round % 2 == 0);
        const FoldGraph graph = fold_graph(problem.edges, regions, problem.bound);
        joined += regions - graph.nodes;
        const auto anchors = anchors_of_nodes(problem, graph);
        std::vector<std::int32_t> of_nodes = likely_folds(graph);
        minimize_cost(graph, anchors, of_nodes);
        std::vector<std::int32_t> folds;
        for (std::size_t i = 0; i < regions; ++i)
            folds.push_back(of_nodes[static_cast<std::size_t>(graph.node_of_region[i])] +
                            graph.fold_in_node[i]);
        EXPECT_LE(cost(problem, folds), least_cost(problem) + 1e-3) << "round " << round;
    }
    EXPECT_GT(joined, 100) << "heavy edges should join regions";
}

TEST(FoldGraph, EdgesOfTwoRegionsBecomeOne) {
    FoldEdge one{0, 2, {}}, other{2, 0, {}}, self{1, 1, {}};
    one.votes.add(1, 2);
    other.votes.add(1, 3);
    std::vector<FoldEdge> edges{one, self, other};
    combine_edges(edges, 3);
    ASSERT_EQ(edges.size(), 1U);
    EXPECT_EQ(edges[0].a, 0);
    EXPECT_EQ(edges[0].b, 2);
    EXPECT_EQ(edges[0].votes.at(1), 2);
    EXPECT_EQ(edges[0].votes.at(-1), 3);
}

TEST(FoldGraph, NodesThatNobodyAnchorsStay) {
    FoldEdge edge{0, 1, {}};
    edge.votes.add(1, 2);
    const FoldGraph graph = fold_graph({edge}, 3, {0, 0, 0});
    std::vector<std::int32_t> folds = likely_folds(graph);
    const std::vector<std::int32_t> before = folds;
    minimize_cost(graph, std::vector<Votes>(static_cast<std::size_t>(graph.nodes)), folds);
    EXPECT_EQ(folds, before);
}

TEST(Votes, ARealNumberCostsItsDistance) {
    for (const float real : {-3.25F, -1.0F, 0.0F, 0.4F, 2.75F}) {
        Votes votes;
        votes.add_real(real, 2);
        for (int number = -5; number <= 5; ++number)
            EXPECT_NEAR(votes.cost(number), 2 * std::abs(static_cast<float>(number) - real), 1e-5F);
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
