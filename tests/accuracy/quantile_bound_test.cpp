// Tests the coverage that accuracy/quantile_bound.h promises, by simulations whose true quantile is
// known: with heavy tails, ties, clusters of related errors, and strata. In each test, the number
// of trials that may miss is the promised share of the trials plus four standard deviations of the
// number of misses.
#include "accuracy/quantile_bound.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/accuracy/infinity.h"

namespace stormcellar::accuracy {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random) {
    return std::uniform_real_distribution<double>()(random);
}

double allowed_misses(int trials, double confidence) {
    const double expected = trials * (1 - confidence);
    return expected + 4 * std::sqrt(expected);
}

struct Outcome {
    int misses = 0, bounds = 0;
    double mean_bound = 0;
};

Outcome simulate(int trials, double truth, const std::function<std::optional<double>()>& bound) {
    Outcome outcome;
    for (int i = 0; i < trials; ++i) {
        const auto found = bound();
        if (!found) continue;
        ++outcome.bounds;
        outcome.mean_bound += *found;
        if (*found < truth) ++outcome.misses;
    }
    outcome.mean_bound /= std::max(1, outcome.bounds);
    return outcome;
}

TEST(QuantileBound, IndependentErrorsAreCoveredAsPromised) {
    struct Law {
        const char* name;
        std::function<double(double)> inverse;  // inverse of the distribution of magnitudes
    };
    const std::vector<Law> laws = {{"uniform", [](double u) { return u; }},
                                   {"exponential", [](double u) { return -std::log1p(-u); }},
                                   {"Pareto without a mean", [](double u) { return 1 / (1 - u); }},
                                   {"mostly zero", [](double u) { return u < 0.985 ? 0 : u; }},
                                   {"ties", [](double u) { return std::floor(u * 50); }}};
    Random random(20261121);
    for (const Law& law : laws) {
        for (const BoundRequest request : {BoundRequest{0.99, 0.9}, BoundRequest{0.95, 0.99}}) {
            // The true quantile: the smallest value such that at most a share 1 - quantile of the
            // magnitudes is larger.
            const double truth = law.inverse(std::nextafter(request.quantile, 0));
            const int trials = 4000;
            const Outcome outcome = simulate(trials, truth, [&] {
                std::vector<double> errors(600);
                for (double& error : errors) {
                    error = law.inverse(uniform(random)) * (random() % 2 == 0 ? 1 : -1);
                }
                return quantile_upper_bound(errors, request);
            });
            EXPECT_EQ(outcome.bounds, trials) << law.name;
            EXPECT_LE(outcome.misses, allowed_misses(trials, request.confidence)) << law.name;
        }
    }
}

TEST(QuantileBound, TheBinomialBoundIsNoLooserThanItMustBe) {
    // With 600 uniform errors, the miss rate of the exact bound is slightly below 10 %.
    Random random(3);
    const Outcome outcome = simulate(4000, 0.95, [&] {
        std::vector<double> errors(600);
        for (double& error : errors)
            error = uniform(random);
        return quantile_upper_bound(errors, {0.95, 0.9});
    });
    EXPECT_GT(outcome.misses, 4000 * 0.06);
    EXPECT_LT(outcome.mean_bound, 0.965);
}

TEST(QuantileBound, TooFewErrorsHaveNoBound) {
    const auto ramp = [](std::size_t n) {
        std::vector<double> errors(n);
        for (std::size_t i = 0; i < n; ++i)
            errors[i] = static_cast<double>(i);
        return errors;
    };
    EXPECT_FALSE(quantile_upper_bound(std::vector<double>{}, {}));
    EXPECT_FALSE(quantile_upper_bound(ramp(687), {}));  // 0.99^687 > 0.001 > 0.99^688
    EXPECT_EQ(quantile_upper_bound(ramp(688), {}), 687);
    EXPECT_FALSE(quantile_upper_bound(ramp(58), {0.95, 0.95}));
    EXPECT_EQ(quantile_upper_bound(ramp(59), {0.95, 0.95}), 58);  // Wilks 1941
    // Conover: the bound is the second largest of 93 errors.
    EXPECT_EQ(quantile_upper_bound(ramp(92), {0.95, 0.95}), 91);
    EXPECT_EQ(quantile_upper_bound(ramp(93), {0.95, 0.95}), 91);
}

TEST(QuantileBound, SenselessRequestsHaveNoBound) {
    const std::vector<double> errors(5000, 1.0);
    const std::vector<ErrorCluster> clusters(5000, ErrorCluster{{1.0}, 1});
    for (const BoundRequest request : {BoundRequest{1, 0.9}, BoundRequest{0, 0.9},
                                       BoundRequest{0.99, 1}, BoundRequest{0.99, 0}}) {
        EXPECT_FALSE(quantile_upper_bound(errors, request));
        EXPECT_FALSE(quantile_upper_bound(clusters, 1, request));
    }
    for (const double most : {0.0, -1.0, infinity, std::nan("")}) {
        EXPECT_FALSE(quantile_upper_bound(clusters, most, {}));
    }
    std::vector<ErrorCluster> larger = clusters;
    larger[7].errors = {1, 1};
    EXPECT_FALSE(quantile_upper_bound(larger, 1, {}));
    EXPECT_TRUE(quantile_upper_bound(larger, 2, {}));
    for (const double weight : {0.0, -1.0, infinity, std::nan("")}) {
        larger[7].weight = weight;
        EXPECT_FALSE(quantile_upper_bound(larger, 2, {}));
    }
}

TEST(QuantileBound, HowManyClustersItTakes) {
    const auto needed = [](std::size_t size, double largest) {
        std::size_t n = 1;
        while (!quantile_upper_bound(
            std::vector<ErrorCluster>(n, {std::vector<double>(size, 1.0), 1}), largest, {})) {
            ++n;
        }
        return n;
    };
    EXPECT_EQ(needed(20, 20), needed(1, 1));
    EXPECT_EQ(needed(20, 20), 902U);  // the binomial bound takes 688
    EXPECT_NEAR(static_cast<double>(needed(5, 20)), 4 * 902, 20);
}

// Draws columns of cells. A share `bad` of the columns is bad. A bad column has more cells, all
// with the same large error, drawn from a distribution without a mean.
struct Columns {
    double bad = 0.01;
    std::size_t small = 4, large = 20;

    [[nodiscard]] ErrorCluster draw(Random& random, bool is_bad) const {
        ErrorCluster cluster;
        if (is_bad) {
            cluster.errors.assign(large, 10 / (1 - uniform(random)));
            return cluster;
        }
        for (std::size_t i = 0; i < small; ++i)
            cluster.errors.push_back(-uniform(random));
        return cluster;
    }
    // A share s of all cells is bad, so for t > 10 a share s * 10 / t of all errors is above t.
    [[nodiscard]] double truth(double quantile) const {
        const double cells_bad = bad * static_cast<double>(large);
        const double share = cells_bad / (cells_bad + (1 - bad) * static_cast<double>(small));
        if (share <= 1 - quantile) return (quantile) / (1 - share);
        return 10 * share / (1 - quantile);
    }
};

TEST(QuantileBound, ClustersThatAreOffTogetherAreCovered) {
    Random random(11);
    const BoundRequest request{0.95, 0.9};
    for (const double bad : {0.005, 0.009, 0.02, 0.1}) {
        const Columns columns{bad};
        const auto sample = [&] {
            std::vector<ErrorCluster> clusters;
            for (int i = 0; i < 1500; ++i)
                clusters.push_back(columns.draw(random, uniform(random) < bad));
            return clusters;
        };
        const int trials = 600;
        const Outcome outcome = simulate(trials, columns.truth(request.quantile), [&] {
            return quantile_upper_bound(sample(), 20, request);
        });
        EXPECT_GT(outcome.bounds, 0.9 * trials) << bad;
        EXPECT_LE(outcome.misses, allowed_misses(trials, request.confidence)) << bad;
    }
}

TEST(QuantileBound, TakingCellsForIndependentWouldMiss) {
    // Treats the cells of the same columns as independent, to show that the test above can fail.
    Random random(12);
    const Columns columns{0.02};
    const int trials = 1000;
    const Outcome outcome = simulate(trials, columns.truth(0.95), [&] {
        std::vector<double> cells;
        for (int i = 0; i < 400; ++i) {
            const auto cluster = columns.draw(random, uniform(random) < columns.bad);
            cells.insert(cells.end(), cluster.errors.begin(), cluster.errors.end());
        }
        return quantile_upper_bound(cells, {0.95, 0.9});
    });
    EXPECT_GT(outcome.misses, 2 * allowed_misses(trials, 0.9));
}

TEST(QuantileBound, StrataDrawnUnevenlyAreCovered) {
    // One tenth of the columns are near the radar and are bad more often. Half of the sample comes
    // from this tenth, and half from all other columns.
    Random random(13);
    const BoundRequest request{0.95, 0.9};
    const Columns near{0.3, 20, 20};
    const Columns far{0.01, 20, 20};
    const double share = 0.1 * near.bad + 0.9 * far.bad;
    ASSERT_LT(share, 1 - request.quantile);
    const double truth = request.quantile / (1 - share);
    const auto sample = [&](double weight_near, double weight_far) {
        std::vector<ErrorCluster> clusters;
        for (int i = 0; i < 300; ++i) {
            clusters.push_back(near.draw(random, uniform(random) < near.bad));
            clusters.back().weight = weight_near;
            clusters.push_back(far.draw(random, uniform(random) < far.bad));
            clusters.back().weight = weight_far;
        }
        return clusters;
    };
    const int trials = 1000;
    const Outcome outcome = simulate(
        trials, truth, [&] { return quantile_upper_bound(sample(0.1, 0.9), 18, request); });
    EXPECT_EQ(outcome.bounds, trials);
    EXPECT_LE(outcome.misses, allowed_misses(trials, request.confidence));
    // Multiplying all weights by one number must not change the bound.
    Random same = random;
    const auto one = quantile_upper_bound(sample(0.125, 1), 20, request);
    random = same;
    EXPECT_EQ(quantile_upper_bound(sample(1000, 8000), 160000, request), one);
}

TEST(QuantileBound, ColumnsDrawnInProportionToTheirSizeAreCovered) {
    // Columns have 1 to 20 cells, and large columns are bad more often. A sample of 1000 columns
    // drawn by size is as good as a much larger sample drawn evenly.
    struct Held {
        std::size_t size;
        bool bad;
    };
    Random random(18);
    std::vector<Held> all;
    std::vector<std::size_t> by_cell;  // the column of each cell
    std::size_t bad_cells = 0;
    for (std::size_t i = 0; i < 5000; ++i) {
        const std::size_t size = 1 + i % 20;
        all.push_back({size, i % 97 == 0 || (size > 17 && i % 7 == 0)});
        by_cell.insert(by_cell.end(), size, i);
        if (all.back().bad) bad_cells += size;
    }
    const double share = static_cast<double>(bad_cells) / static_cast<double>(by_cell.size());
    ASSERT_LT(share, 0.05);
    const int trials = 1000;
    const Outcome outcome = simulate(trials, 0.95 / (1 - share), [&] {
        std::vector<ErrorCluster> clusters;
        for (int i = 0; i < 1000; ++i) {
            const Held& held = all[by_cell[random() % by_cell.size()]];
            ErrorCluster cluster{{}, 1 / static_cast<double>(held.size)};
            for (std::size_t k = 0; k < held.size; ++k) {
                cluster.errors.push_back(held.bad ? 5 : uniform(random));
            }
            clusters.push_back(cluster);
        }
        return quantile_upper_bound(clusters, 1, {0.95, 0.9});
    });
    EXPECT_EQ(outcome.bounds, trials);
    EXPECT_LE(outcome.misses, allowed_misses(trials, 0.9));
}

TEST(QuantileBound, ColumnsDrawnWithoutReplacementAreCovered) {
    Random random(14);
    const Columns columns{0.02};
    std::vector<ErrorCluster> all;
    std::vector<double> cells;
    for (int i = 0; i < 1500; ++i) {
        all.push_back(columns.draw(random, i % 50 == 0));
        for (const double error : all.back().errors)
            cells.push_back(std::fabs(error));
    }
    std::sort(cells.begin(), cells.end());
    const double truth =
        cells[static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(cells.size()))) - 1];
    const int trials = 1000;
    const Outcome outcome = simulate(trials, truth, [&] {
        std::shuffle(all.begin(), all.end(), random);
        return quantile_upper_bound(std::span(all).first(900), 20, {0.95, 0.9});
    });
    EXPECT_EQ(outcome.bounds, trials);
    EXPECT_LE(outcome.misses, allowed_misses(trials, 0.9));
}

TEST(QuantileBound, AtTheConfidenceThatIsUsedNearlyNoneMisses) {
    Random random(15);
    const Columns columns{0.003, 5, 5};
    const int trials = 400;
    const Outcome outcome = simulate(trials, columns.truth(0.99), [&] {
        std::vector<ErrorCluster> clusters;
        for (int i = 0; i < 6000; ++i) {
            clusters.push_back(columns.draw(random, uniform(random) < columns.bad));
        }
        return quantile_upper_bound(clusters, 5, {});
    });
    EXPECT_EQ(outcome.bounds, trials);
    EXPECT_LE(outcome.misses, 3);
}

TEST(QuantileBound, WithManyClustersTheBoundComesNear) {
    // With independent errors, the bound from 20,000 columns of 10 cells is within 1 % of the 99th
    // percentile.
    Random random(16);
    std::vector<ErrorCluster> clusters(20000);
    for (ErrorCluster& cluster : clusters) {
        for (int i = 0; i < 10; ++i)
            cluster.errors.push_back(uniform(random));
    }
    const auto bound = quantile_upper_bound(clusters, 10, {});
    ASSERT_TRUE(bound);
    EXPECT_GT(*bound, 0.99);
    EXPECT_LT(*bound, 0.994);
}

TEST(QuantileBound, ANanCountsAsInfinite) {
    std::vector<double> errors(688, 1.0);
    errors[5] = std::nan("");
    EXPECT_EQ(quantile_upper_bound(errors, {}), infinity);
    std::vector<ErrorCluster> clusters(902, {{1.0}, 1});
    clusters[5].errors[0] = std::nan("");
    EXPECT_EQ(quantile_upper_bound(clusters, 1, {}), infinity);
}

TEST(QuantileBound, TheOrderOfClustersAndTheirCellsMeansNothing) {
    Random random(17);
    const Columns columns{0.02};
    std::vector<ErrorCluster> clusters;
    for (int i = 0; i < 2000; ++i)
        clusters.push_back(columns.draw(random, uniform(random) < 0.02));
    const auto bound = quantile_upper_bound(clusters, 20, {0.95, 0.99});
    ASSERT_TRUE(bound);
    std::shuffle(clusters.begin(), clusters.end(), random);
    for (ErrorCluster& cluster : clusters)
        std::reverse(cluster.errors.begin(), cluster.errors.end());
    EXPECT_EQ(quantile_upper_bound(clusters, 20, {0.95, 0.99}), bound);
}

}  // namespace
}  // namespace stormcellar::accuracy
