// Compares the filter with sorted lists.
#include "retrieve/shear/median_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/retrieve/velocity_sweep.h"

namespace stormcellar::retrieve {
namespace {

constexpr float no_velocity = std::numeric_limits<float>::quiet_NaN();

VelocityRows random_rows(std::size_t radials, std::size_t gates, double missing) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> velocity(-30, 30);
    std::bernoulli_distribution is_missing(missing);
    VelocityRows rows;
    rows.gates = gates;
    for (std::size_t row = 0; row < radials; ++row) {
        rows.radials.push_back(row);
        rows.azimuths_deg.push_back(static_cast<float>(row));
        for (std::size_t gate = 0; gate < gates; ++gate)
            rows.velocities_mps.push_back(is_missing(random) ? no_velocity : velocity(random));
    }
    return rows;
}

// Sorts the velocities of the gates around a gate, as far as rows are beside each other.
float plain_median(const VelocityRows& rows, std::size_t row, std::size_t gate) {
    std::vector<float> around;
    for (std::size_t other = 0; other < rows.row_count(); ++other) {
        const double turn = turn_deg(static_cast<double>(rows.azimuths_deg[row]),
                                     static_cast<double>(rows.azimuths_deg[other]));
        if (std::abs(turn) > 1.5) continue;
        for (std::size_t near = gate == 0 ? 0 : gate - 1; near < std::min(gate + 2, rows.gates);
             ++near)
            if (!std::isnan(rows.row(other)[near])) around.push_back(rows.row(other)[near]);
    }
    std::ranges::sort(around);
    const std::size_t half = around.size() / 2;
    return around.size() % 2 == 1 ? around[half] : (around[half - 1] + around[half]) / 2;
}

void expect_plain_medians(const VelocityRows& rows) {
    const std::vector<float> filtered = median_filtered(rows);
    for (std::size_t row = 0; row < rows.row_count(); ++row) {
        for (std::size_t gate = 0; gate < rows.gates; ++gate) {
            const float found = filtered[row * rows.gates + gate];
            if (std::isnan(rows.row(row)[gate]))
                ASSERT_TRUE(std::isnan(found)) << row << " " << gate;
            else
                ASSERT_EQ(found, plain_median(rows, row, gate)) << row << " " << gate;
        }
    }
}

TEST(MedianFilter, EqualsSortedLists) {
    for (const double missing : {0.0, 0.1, 0.5, 0.9}) {
        expect_plain_medians(random_rows(360, 70, missing));
        expect_plain_medians(random_rows(50, 64, missing));  // a sector
    }
}

TEST(MedianFilter, FewRowsAndGatesAreNoTrouble) {
    for (const std::size_t radials : {1U, 2U, 3U})
        for (const std::size_t gates : {1U, 2U, 3U})
            expect_plain_medians(random_rows(radials, gates, 0));
    EXPECT_TRUE(median_filtered({}).empty());
}

TEST(MedianFilter, DoesNotReachAcrossAGap) {
    VelocityRows rows = random_rows(20, 40, 0.2);
    for (std::size_t row = 10; row < 20; ++row)
        rows.azimuths_deg[row] += 30;
    expect_plain_medians(rows);
}

}  // namespace
}  // namespace stormcellar::retrieve
