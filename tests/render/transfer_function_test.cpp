#include "render/volume/transfer_function.h"

#include <cmath>

#include <gtest/gtest.h>

#include "render/colour/colour_table.h"

namespace stormcellar::render {
namespace {

const grid::Quantization half_db{1, -32, 0.5F};

int bin_of_dbz(double dbz) {
    return static_cast<int>((dbz - TransferFunction::first_bin_dbz) / TransferFunction::bin_dbz);
}

TEST(TransferFunction, FirstVisibleCodeIsFiveDbz) {
    const TransferFunction transfer(nws_reflectivity(), half_db, 1, 1000);
    EXPECT_EQ(half_db.value_of(static_cast<std::uint16_t>(transfer.first_visible_code())), 5);
}

// Every code of every quantisation falls into the bin whose bounds hold its value.
TEST(TransferFunction, BinsHoldTheirValues) {
    for (const grid::Quantization& quantization :
         {half_db, grid::Quantization{2, -32, 0.01F}, grid::Quantization{1, -30, 1}}) {
        const TransferFunction transfer(nws_reflectivity(), quantization, 1, 1000);
        for (std::uint32_t code = 3; code <= quantization.largest_code(); ++code) {
            const double dbz =
                static_cast<double>(quantization.value_of(static_cast<std::uint16_t>(code)));
            const int expected =
                std::min(255, static_cast<int>(std::floor((dbz + 32) / 0.5 + 1.0 / 64)));
            ASSERT_NEAR(transfer.bin(static_cast<float>(code)), expected,
                        quantization.code_bytes == 1 ? 0 : 1)
                << code;
        }
    }
}

TEST(TransferFunction, OpacityRisesWithReflectivity) {
    const TransferFunction transfer(nws_reflectivity(), half_db, 1, 1000);
    for (int bin = bin_of_dbz(5); bin < TransferFunction::bin_count; ++bin) {
        const float alpha = transfer.entry(bin, bin).alpha;
        const float below = transfer.entry(bin - 1, bin - 1).alpha;
        EXPECT_TRUE(alpha > below || below > 0.9999F) << bin;
        EXPECT_LE(alpha, 1);
    }
}

TEST(TransferFunction, OpacityIsCorrectedForTheStep) {
    const TransferFunction reference(nws_reflectivity(), half_db, 1, 1000.0);
    for (const double ratio : {0.1, 0.5, 3.0, 20.0}) {
        const TransferFunction other(nws_reflectivity(), half_db, 1, ratio * 1000.0);
        for (const double dbz : {6.0, 23.0, 41.5, 52.0, 60.0}) {
            const int bin = bin_of_dbz(dbz);
            const double a = static_cast<double>(reference.entry(bin, bin).alpha);
            EXPECT_NEAR(static_cast<double>(other.entry(bin, bin).alpha),
                        1 - std::pow(1 - a, ratio), 2e-6);
        }
    }
}

TEST(TransferFunction, ColoursArePremultiplied) {
    const TransferFunction transfer(nws_reflectivity(), half_db, 1, 1000);
    const TransferEntry& red = transfer.entry(bin_of_dbz(52), bin_of_dbz(52));
    EXPECT_FLOAT_EQ(red.red, red.alpha * 253 / 255);
    EXPECT_EQ(red.green, 0);
}

// A step that crosses several classes against the slow sum over all values between its ends.
TEST(TransferFunction, AStepHoldsEveryClassBetweenItsEnds) {
    const double step_m = 700;
    const TransferFunction transfer(nws_reflectivity(), half_db, 1, step_m);
    for (const auto& [low, high] : {std::pair{-20.0, 30.0}, std::pair{12.0, 14.0},
                                    std::pair{33.0, 61.0}, std::pair{5.0, 75.0}}) {
        double extinction = 0;
        double weighted_green = 0;
        const int bins = static_cast<int>((high - low) / 0.5) + 1;
        for (int i = 0; i < bins; ++i) {
            const double dbz = low + 0.5 * i;
            extinction += extinction_per_m(nws_reflectivity(), dbz, 1);
            const auto colour = colour_of(nws_reflectivity(), static_cast<float>(dbz));
            if (colour)
                weighted_green += extinction_per_m(nws_reflectivity(), dbz, 1) * (*colour)[1] / 255;
        }
        const double alpha = 1 - std::exp(-extinction / bins * step_m);
        const TransferEntry& entry = transfer.entry(bin_of_dbz(low), bin_of_dbz(high));
        EXPECT_NEAR(static_cast<double>(entry.alpha), alpha, 1e-6);
        EXPECT_NEAR(static_cast<double>(entry.green), alpha * weighted_green / extinction, 1e-6);
        EXPECT_EQ(transfer.entry(bin_of_dbz(high), bin_of_dbz(low)).green, entry.green);
    }
}

TEST(TransferFunction, AllCodesBelowTheTableAreClear) {
    EXPECT_EQ(TransferFunction(nws_reflectivity(), {1, -200, 0.1F}, 1, 1000).first_visible_code(),
              256U);
}

}  // namespace
}  // namespace stormcellar::render
