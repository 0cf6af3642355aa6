#include "grid/judge/robust_fit.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

constexpr std::array<double, fit_size> truth = {1.5, -0.5, 0.25, 3};
constexpr FitChoice all = {true, true, true, true};

// Returns rows of a linear model. The rows of a block have an error in common.
std::vector<FitRow> made(unsigned seed, int blocks, int rows_a_block, double common, double own) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<FitRow> rows;
    for (int block = 0; block < blocks; ++block) {
        std::array<double, fit_size> center{};
        for (double& number : center)
            number = normal(random);
        const double shared = common * normal(random);
        for (int i = 0; i < rows_a_block; ++i) {
            FitRow row;
            row.block = static_cast<std::uint32_t>(block);
            row.residual = shared + own * normal(random);
            for (std::size_t j = 0; j < fit_size; ++j) {
                row.gradient[j] = center[j] + 0.2 * normal(random);
                row.residual += truth[j] * row.gradient[j];
            }
            rows.push_back(row);
        }
    }
    return rows;
}

TEST(RobustFit, FindsExactNumbers) {
    const auto found = fit(made(1, 20, 10, 0, 0), all);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->blocks, 20U);
    for (std::size_t i = 0; i < fit_size; ++i) {
        EXPECT_NEAR(found->step[i], truth[i], 1e-9);
        EXPECT_NEAR(found->standard_error[i], 0, 1e-6);
    }
}

// Moves a tenth of the rows far off; the result may change only a little.
TEST(RobustFit, OutliersHardlyCount) {
    auto rows = made(2, 60, 20, 0, 0.1);
    for (std::size_t i = 0; i < rows.size(); i += 10)
        rows[i].residual += 1000;
    const auto found = fit(rows, all);
    ASSERT_TRUE(found);
    for (std::size_t i = 0; i < fit_size; ++i)
        EXPECT_NEAR(found->step[i], truth[i], 1.5);
    EXPECT_LT(found->deviation, 20);
}

// The stated errors must equal the scatter over many draws, although the rows of a block have an
// error in common. Errors computed from the number of rows alone would be a quarter of the scatter.
TEST(RobustFit, ErrorsAreThoseOfBlocksThatAreOffTogether) {
    std::array<double, fit_size> scatter{}, stated{};
    constexpr int draws = 200;
    for (unsigned seed = 0; seed < draws; ++seed) {
        // Compute residuals about the truth, as after the last step.
        auto rows = made(100 + seed, 40, 30, 1, 0.3);
        for (FitRow& row : rows) {
            for (std::size_t j = 0; j < fit_size; ++j)
                row.residual -= truth[j] * row.gradient[j];
        }
        const auto found = fit(rows, all);
        ASSERT_TRUE(found);
        for (std::size_t i = 0; i < fit_size; ++i) {
            scatter[i] += found->step[i] * found->step[i] / draws;
            stated[i] += found->standard_error[i] * found->standard_error[i] / draws;
        }
    }
    for (std::size_t i = 0; i < fit_size; ++i) {
        EXPECT_GT(std::sqrt(stated[i] / scatter[i]), 0.8) << i;
        EXPECT_LT(std::sqrt(stated[i] / scatter[i]), 1.6) << i;
    }
}

TEST(RobustFit, WhatIsNotSoughtStaysAndWhatIsUnclearIsNamed) {
    auto rows = made(3, 20, 10, 0, 0.1);
    const auto found = fit(rows, {true, true, true, false});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->step[3], 0);
    for (FitRow& row : rows)
        row.gradient[2] = 2 * row.gradient[1];
    std::size_t unclear = 9;
    EXPECT_FALSE(fit(rows, all, &unclear));
    EXPECT_EQ(unclear, 2U);
    EXPECT_TRUE(fit(rows, {true, true, false, true}));
    EXPECT_FALSE(fit({}, all));
}

}  // namespace
}  // namespace stormcellar::grid
