// Compares the slopes of all windows with a fit of each single window, for the vectors of each
// processor.
#include "retrieve/kdp/window_slopes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace stormcellar::retrieve {
namespace {

constexpr std::ptrdiff_t row_reach = 41, eighths = 8;
constexpr std::array<std::ptrdiff_t, 3> window_gates = {7, 13, 41};

// A noisy ramp, a third of whose gates is not good.
PhaseRow holed_ramp(std::size_t gates) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 2);
    PhaseRow row{std::vector<double>(gates, 0), std::vector<std::uint8_t>(gates, 0), {}};
    for (std::size_t gate = 0; gate < gates; ++gate) {
        if (random() % 3 == 0) continue;
        row.is_good[gate] = 1;
        row.phases_deg[gate] = 0.4 * static_cast<double>(gate * gate) / 50 + noise(random);
    }
    return row;
}

TEST(WindowSlopes, SumsOfRangesAreThoseOfTheirGoodGates) {
    const PhaseRow row = holed_ramp(61);
    RowSums sums;
    sums.read(holed_ramp(90), row_reach);  // its memory is used again
    sums.read(row, row_reach);
    for (std::ptrdiff_t begin = -row_reach; begin <= 61; begin += 3)
        for (const std::ptrdiff_t gates : window_gates) {
            LineSums expected;
            for (std::ptrdiff_t gate = std::max<std::ptrdiff_t>(0, begin);
                 gate < std::min<std::ptrdiff_t>(61, begin + gates); ++gate) {
                const auto at = static_cast<std::size_t>(gate);
                const double x = static_cast<double>(gate), y = row.phases_deg[at];
                if (row.is_good[at] != 0)
                    expected = expected + LineSums{1, x, y, x * x, x * y, y * y};
            }
            const LineSums found = sums.between(begin, begin + gates);
            EXPECT_EQ(found.n, expected.n);
            EXPECT_EQ(sums.count(begin, begin + gates), expected.n);
            EXPECT_EQ(found.x, expected.x);
            EXPECT_EQ(found.xx, expected.xx);
            EXPECT_NEAR(found.y, expected.y, 1e-9);
            EXPECT_NEAR(found.xy, expected.xy, 1e-7);
            EXPECT_NEAR(found.yy, expected.yy, 1e-7);
        }
}

struct OneSlope {
    float slope = 0, error = 0, fit_error = 0, precision = 0;  // no slope if the error is 0
    bool is_line = false;
};

// Fits the window of which `part` eighths are before the gate.
OneSlope slope_in(const RowSums& sums, const std::vector<double>& noise, std::ptrdiff_t gate,
                  std::ptrdiff_t part, std::ptrdiff_t gates) {
    const std::ptrdiff_t begin = gate - part * (gates - 1) / eighths;
    const LineSums of_window = sums.between(begin, begin + gates);
    if (of_window.n < std::max(5.0, 0.6 * static_cast<double>(gates))) return {};
    const auto line = line_of(of_window);
    if (!line) return {};
    const auto last = static_cast<std::ptrdiff_t>(noise.size()) - 1;
    const auto middle = std::clamp<std::ptrdiff_t>(begin + gates / 2, 0, last);
    const double noise_deg = noise[static_cast<std::size_t>(middle)];
    const double scale = 1 / std::sqrt(line->spread), left = residual_deg(of_window, *line);
    const double fit = std::max(noise_deg, left) * scale;
    return {static_cast<float>(line->slope), static_cast<float>(noise_deg * scale),
            static_cast<float>(fit), static_cast<float>(1 / (fit * fit)), left <= 1.5 * noise_deg};
}

struct MeanByWindow {
    bool is_even = false;
    float weight = 0, slope = 0, square = 0, error = 0;

    MeanByWindow(const RowSums& sums, const std::vector<double>& noise, std::ptrdiff_t gate) {
        int lines = 0, others = 0;
        for (std::ptrdiff_t part = 0; part <= eighths; ++part) {
            const OneSlope one = slope_in(sums, noise, gate, part, window_gates.back());
            if (one.error > 0) ++(one.is_line ? lines : others);
        }
        is_even = lines > 2 * others;
        for (std::ptrdiff_t part = 0; part <= eighths; ++part)
            add(sums, noise, gate, part);
    }
    void add(const RowSums& sums, const std::vector<double>& noise, std::ptrdiff_t gate,
             std::ptrdiff_t part) {
        float low = -std::numeric_limits<float>::infinity(), high = -low;
        for (const std::ptrdiff_t gates : window_gates) {
            const OneSlope one = slope_in(sums, noise, gate, part, gates);
            if (one.error == 0) continue;
            low = std::max(low, one.slope - 2.3F * one.error);
            high = std::min(high, one.slope + 2.3F * one.error);
            if (low > high) return;
            const float share = 2 * part == eighths ? 1 : 0.1F;
            const float own = share * (is_even ? one.precision : one.precision * one.error);
            weight += own;
            slope += own * one.slope;
            square += own * one.slope * one.slope;
            error += own * one.fit_error;
        }
    }
};

struct Found {
    int even = 0, uneven = 0, none = 0;  // gates
};
Found expect_means_of(const PhaseRow& row) {
    const std::size_t gates = row.phases_deg.size();
    RowSums sums;
    sums.read(row, row_reach);
    std::vector<double> noise(gates);
    for (std::size_t gate = 0; gate < gates; ++gate)
        noise[gate] = 1.5 + 0.05 * static_cast<double>(gate % 17);
    std::vector<double> extended(noise);
    extended.insert(extended.begin(), row_reach, noise.front());
    extended.resize(extended.size() + row_reach + RowSums::spare, noise.back());
    std::vector<WindowSlopes> lengths;
    for (const std::ptrdiff_t length : window_gates) {
        const double least = std::max(5.0, 0.6 * static_cast<double>(length));
        lengths.emplace_back().gates = length;
        fit_windows(sums, extended, row_reach, {2.3F, least, 1.5}, lengths.back());
    }
    SlopeSums means;
    means.begin(lengths.back(), eighths, gates);
    for (std::ptrdiff_t part = 0; part <= eighths; ++part)
        add_windows(lengths, part, eighths, 2 * part == eighths ? 1 : 0.1F, gates, means);
    Found found;
    for (std::size_t gate = 0; gate < gates; ++gate) {
        const MeanByWindow expected(sums, noise, static_cast<std::ptrdiff_t>(gate));
        EXPECT_EQ(means.is_even[gate], expected.is_even ? 1 : 0) << gate;
        EXPECT_EQ(means.weights[gate], expected.weight) << gate;
        EXPECT_EQ(means.slopes[gate], expected.slope) << gate;
        EXPECT_EQ(means.squares[gate], expected.square) << gate;
        EXPECT_EQ(means.errors[gate], expected.error) << gate;
        const bool has_slope = expected.weight > 0;
        ++(!has_slope ? found.none : expected.is_even ? found.even : found.uneven);
    }
    return found;
}

TEST(WindowSlopes, MeansAreThoseOfOneWindowAfterAnother) {
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        for (const std::size_t gates : {1U, 5U, 33U})
            (void)expect_means_of(holed_ramp(gates));
        // The slope rises along the row, so the end of the row is no straight line.
        const Found found = expect_means_of(holed_ramp(160));
        EXPECT_GT(found.even, 0);
        EXPECT_GT(found.uneven, 0);
        EXPECT_EQ(expect_means_of(holed_ramp(4)).none, 4);
        hwy::SetSupportedTargetsForTest(0);
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
