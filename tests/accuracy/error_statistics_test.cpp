#include "stormcellar/accuracy/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/accuracy/infinity.h"

namespace stormcellar::accuracy {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(ErrorStatistics, NothingHasNoSummary) {
    EXPECT_FALSE(summarize(std::vector<double>{}));
    EXPECT_FALSE(summarize(std::vector<ErrorCluster>{}));
    EXPECT_FALSE(summarize(std::vector<ErrorCluster>{{{}, 1}, {{}, 2}}));
}

TEST(ErrorStatistics, FiguresAreOfMagnitudes) {
    const auto summary = summarize(std::vector<double>{-3, 4});
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->count, 2U);
    EXPECT_DOUBLE_EQ(summary->rms, std::sqrt(12.5));
    EXPECT_EQ(summary->p95, 4);
    EXPECT_EQ(summary->max, 4);
    const auto zero = summarize(std::vector<double>{0, -0.0});
    EXPECT_EQ(zero->rms, 0);
    EXPECT_EQ(zero->max, 0);
}

// Finds the quantile by counting: the smallest error for which at least q percent of all errors are
// as small or smaller.
double counted_quantile(const std::vector<double>& errors, std::size_t q_percent) {
    std::vector<double> magnitudes;
    for (const double error : errors)
        magnitudes.push_back(std::fabs(error));
    double best = infinity;
    for (const double candidate : magnitudes) {
        const auto not_above = static_cast<std::size_t>(std::count_if(
            magnitudes.begin(), magnitudes.end(), [&](double m) { return m <= candidate; }));
        if (not_above * 100 >= q_percent * magnitudes.size()) best = std::min(best, candidate);
    }
    return best;
}

TEST(ErrorStatistics, QuantilesAreThoseThatCountingFinds) {
    std::mt19937_64 random(20261121);
    std::normal_distribution<double> normal;
    for (std::size_t n = 1; n <= 420; ++n) {
        std::vector<double> errors(n);
        for (double& error : errors)
            error = std::round(normal(random) * 20) / 10;  // with ties
        const auto summary = summarize(errors);
        ASSERT_TRUE(summary);
        EXPECT_EQ(summary->p95, counted_quantile(errors, 95)) << n;
        EXPECT_EQ(summary->p99, counted_quantile(errors, 99)) << n;
    }
}

TEST(ErrorStatistics, AWeightOfThreeIsThreeOfTheSame) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<ErrorCluster> clusters;
        std::vector<double> repeated;
        for (int i = 0; i < 30; ++i) {
            ErrorCluster cluster;
            cluster.weight = static_cast<double>(1 + random() % 3);
            for (std::size_t k = random() % 5; k > 0; --k)
                cluster.errors.push_back(normal(random));
            for (int w = 0; w < static_cast<int>(cluster.weight); ++w) {
                repeated.insert(repeated.end(), cluster.errors.begin(), cluster.errors.end());
            }
            clusters.push_back(cluster);
        }
        const auto weighted = summarize(clusters);
        const auto plain = summarize(repeated);
        ASSERT_EQ(weighted.has_value(), plain.has_value());
        if (!plain) continue;
        EXPECT_EQ(weighted->p95, plain->p95);
        EXPECT_EQ(weighted->p99, plain->p99);
        EXPECT_EQ(weighted->max, plain->max);
        EXPECT_NEAR(weighted->rms, plain->rms, 1e-12);
    }
}

TEST(ErrorStatistics, ANanHidesNothing) {
    const auto summary = summarize(std::vector<double>{1, nan, 2});
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->max, infinity);
    EXPECT_EQ(summary->p99, infinity);
    EXPECT_EQ(summary->rms, infinity);
    std::vector<double> many(1000, 1.0);
    many[0] = nan;
    EXPECT_EQ(summarize(many)->p99, 1);
    EXPECT_EQ(summarize(many)->max, infinity);
}

TEST(ErrorStatistics, HugeErrorsDoNotOverflow) {
    const auto summary = summarize(std::vector<double>{1e300, -1e300});
    EXPECT_DOUBLE_EQ(summary->rms, 1e300);
}

TEST(ErrorStatistics, StatusDisagreementsAreAShare) {
    StatusCounts counts;
    EXPECT_EQ(counts.share(), 0);
    counts += {300, 1};
    counts += {100, 1};
    EXPECT_EQ(counts, (StatusCounts{400, 2}));
    EXPECT_EQ(counts.share(), 0.005);
}

}  // namespace
}  // namespace stormcellar::accuracy
