#include "render/volume/transfer_function.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

const grid::Quantization half_db{1, -32, 0.5F};

TransferFunction of_reflectivity(double step_m, Integration integration,
                                 const grid::Quantization& quantization = half_db) {
    return TransferFunction(nws_reflectivity(), quantization, 1, step_m, integration);
}

int bin_of(const TransferFunction& transfer, double value) {
    return transfer.bin(static_cast<float>((value + 32) / 0.5 + grid::first_value_code));
}

double alpha_of(const TransferEntry& entry) {
    return -std::expm1(-static_cast<double>(entry.depth));
}

// Every code of every quantization falls into the bin whose bounds contain its value.
TEST(TransferFunction, BinsHoldTheirValues) {
    for (const grid::Quantization& quantization :
         {half_db, grid::Quantization{2, -32, 0.01F}, grid::Quantization{1, -30, 1}}) {
        const auto transfer = of_reflectivity(1000, Integration::riemann, quantization);
        for (std::uint32_t code = 3; code <= quantization.largest_code(); ++code) {
            const auto dbz =
                static_cast<double>(quantization.value_of(static_cast<std::uint16_t>(code)));
            const int bin = transfer.bin(static_cast<float>(code));
            if (dbz < 5) {
                ASSERT_EQ(bin, 0) << dbz;
            } else if (bin < TransferFunction::bin_count - 1) {
                ASSERT_NEAR(transfer.value_of(bin), dbz, 0.52 * transfer.bin_width()) << dbz;
            }
        }
    }
}

TEST(TransferFunction, TheNumberOfThreadsChangesNoBit) {
    for (const Integration integration : {Integration::first_order, Integration::second_order}) {
        const auto one = of_reflectivity(1000, integration);
        const TransferFunction many(nws_reflectivity(), half_db, 1, 1000, integration, 5);
        for (int near = 0; near < TransferFunction::bin_count; ++near) {
            for (int far = 0; far < TransferFunction::bin_count; ++far) {
                const TransferEntry &a = one.entry(near, far), &b = many.entry(near, far);
                ASSERT_EQ(a.red, b.red) << near << " " << far;
                ASSERT_EQ(a.green, b.green);
                ASSERT_EQ(a.blue, b.blue);
                ASSERT_EQ(a.depth, b.depth);
            }
        }
    }
}

TEST(TransferFunction, EachClassBeginsABin) {
    const auto transfer = of_reflectivity(1000, Integration::riemann);
    for (const ColorStop& stop : nws_reflectivity().stops) {
        const int bin = bin_of(transfer, stop.from);
        EXPECT_NEAR(transfer.value_of(bin) - transfer.bin_width() / 2, stop.from, 1e-6);
    }
}

TEST(TransferFunction, ShowsWhatIsNotClear) {
    const auto transfer = of_reflectivity(1000, Integration::second_order);
    const auto code = [](double dbz) { return static_cast<std::uint16_t>((dbz + 32) / 0.5 + 3); };
    EXPECT_FALSE(transfer.shows(code(-32), code(4.5)));
    EXPECT_TRUE(transfer.shows(code(-32), code(5)));
    EXPECT_TRUE(transfer.shows(code(70), code(70)));

    ColorTable gap;
    gap.stops = {{0, {1, 2, 3, 255}, {1, 2, 3, 255}}, {40, {9, 9, 9, 255}, {9, 9, 9, 255}}};
    gap.end = 80;
    gap.extinction = {{0, 1}, {10, 0}, {30, 0}, {40, 1}};
    const TransferFunction middle(gap, half_db, 1, 1000, Integration::second_order);
    EXPECT_FALSE(middle.shows(code(12), code(28)));
    EXPECT_TRUE(middle.shows(code(8), code(28)));
    EXPECT_TRUE(middle.shows(code(12), code(35)));
    EXPECT_TRUE(middle.shows(code(5), code(50)));
}

TEST(TransferFunction, ATableOfOneStopIsATable) {
    ColorTable one;
    one.stops = {{20, {10, 20, 30, 255}, {10, 20, 30, 255}}};
    one.end = 30;
    one.extinction = {{20, 0.5}};
    const TransferFunction transfer(one, half_db, 2, 1000, Integration::second_order);
    EXPECT_EQ(transfer.entry(bin_of(transfer, 19), bin_of(transfer, 19)).depth, 0);
    EXPECT_FLOAT_EQ(transfer.entry(bin_of(transfer, 21), bin_of(transfer, 70)).depth, 1);
}

// The result of integrate(), which sums 20,000 pieces from the nearer value to the farther value.
struct Exact {
    double alpha = 0;
    std::array<double, 3> color{};
};
Exact integrate(double from, double to, double step_m) {
    constexpr int pieces = 20000;
    Exact sum;
    double through = 1;
    for (int i = 0; i < pieces; ++i) {
        const double value = from + (to - from) * (i + 0.5) / pieces;
        const auto color = color_of(nws_reflectivity(), static_cast<float>(value));
        if (!color) continue;
        const double seen = through * -std::expm1(-extinction_per_m(nws_reflectivity(), value, 1) *
                                                  step_m / pieces);
        for (std::size_t c = 0; c < 3; ++c)
            sum.color[c] += seen * (*color)[c] / 255;
        through -= seen;
    }
    sum.alpha = 1 - through;
    return sum;
}

// Compares steps between the middles of two bins with integrate().
TEST(TransferFunction, SecondOrderIsTheIntegralInItsOrder) {
    for (const double step_m : {50.0, 700.0, 8000.0}) {
        const auto transfer = of_reflectivity(step_m, Integration::second_order);
        for (const auto& [from, to] :
             {std::pair{12.0, 14.0}, std::pair{33.0, 61.0}, std::pair{61.0, 33.0},
              std::pair{5.5, 75.0}, std::pair{75.0, 5.5}, std::pair{47.0, 47.0}}) {
            const int one = bin_of(transfer, from);
            const int other = bin_of(transfer, to);
            const TransferEntry& entry = transfer.entry(one, other);
            const Exact exact = integrate(transfer.value_of(one), transfer.value_of(other), step_m);
            const double alpha = alpha_of(entry);
            EXPECT_NEAR(alpha, exact.alpha, 2e-3) << step_m << " " << from << " " << to;
            EXPECT_NEAR(alpha * entry.red, exact.color[0], 6e-3);
            EXPECT_NEAR(alpha * entry.green, exact.color[1], 6e-3);
            EXPECT_NEAR(alpha * entry.blue, exact.color[2], 6e-3);
        }
    }
}

TEST(TransferFunction, SecondOrderTellsFrontFromBack) {
    const auto transfer = of_reflectivity(4000, Integration::second_order);
    const int weak = bin_of(transfer, 22);
    const int strong = bin_of(transfer, 57);
    EXPECT_GT(transfer.entry(weak, strong).green, 1.5F * transfer.entry(strong, weak).green);
    EXPECT_EQ(transfer.entry(weak, strong).depth, transfer.entry(strong, weak).depth);
    const auto first = of_reflectivity(4000, Integration::first_order);
    EXPECT_EQ(first.entry(weak, strong).green, first.entry(strong, weak).green);
}

// A thin step hides nothing, so both orders give the mean color weighted by extinction.
TEST(TransferFunction, OrdersMeetInThinSteps) {
    const auto first = of_reflectivity(0.01, Integration::first_order);
    const auto second = of_reflectivity(0.01, Integration::second_order);
    for (int low = 1; low < TransferFunction::bin_count; low += 9) {
        for (int high = 1; high < TransferFunction::bin_count; high += 7) {
            const TransferEntry& a = first.entry(low, high);
            const TransferEntry& b = second.entry(low, high);
            ASSERT_NEAR(a.depth, b.depth, 1e-5F * a.depth);
            ASSERT_NEAR(a.red, b.red, 2e-3);
            ASSERT_NEAR(a.green, b.green, 2e-3);
        }
    }
}

TEST(TransferFunction, RiemannTakesTheNearerValue) {
    const auto transfer = of_reflectivity(1000, Integration::riemann);
    const int red = bin_of(transfer, 52);
    const int other = bin_of(transfer, 20);
    const TransferEntry& entry = transfer.entry(red, other);
    EXPECT_FLOAT_EQ(entry.red, 253 / 255.0F);
    EXPECT_EQ(entry.green, 0);
    EXPECT_NEAR(entry.depth, extinction_per_m(nws_reflectivity(), transfer.value_of(red), 1) * 1000,
                1e-6);
    EXPECT_EQ(transfer.entry(0, red).depth, 0);
}

}  // namespace
}  // namespace stormcellar::render
