// Compares the loops with obvious loops, for the vectors of each processor and for counts that do
// not fill a vector.
#include "retrieve/quality/gate_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "retrieve/quality/gate_field.h"

namespace stormcellar::retrieve {
namespace {

constexpr std::uint32_t one_number = 1U << BoxSum::sum_bits;

void on_each_target(const std::function<void(std::size_t gates)>& test) {
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        for (const std::size_t gates : {0U, 1U, 7U, 16U, 61U, 200U})
            test(gates);
        hwy::SetSupportedTargetsForTest(0);
    }
}

// A third of the codes is 0.
std::vector<std::uint16_t> random_codes(std::size_t gates, unsigned seed, unsigned most) {
    std::mt19937 random(seed);
    std::vector<std::uint16_t> codes(gates);
    for (std::uint16_t& code : codes)
        code = static_cast<std::uint16_t>(random() % 3 == 0 ? 0 : random() % (most + 1));
    return codes;
}

TEST(GateLoops, KeepValidCodesOfBothSizes) {
    on_each_target([](std::size_t gates) {
        const auto wide = random_codes(gates, 1, 4);
        const std::vector<std::uint8_t> narrow(wide.begin(), wide.end());
        std::vector<std::uint16_t> expected(wide), of_wide(gates), of_narrow(gates);
        std::ranges::replace_if(
            expected, [](std::uint16_t code) { return code < 2; }, 0);
        keep_valid_codes(wide.data(), gates, 2, of_wide.data());
        keep_valid_codes(narrow.data(), gates, 2, of_narrow.data());
        EXPECT_EQ(of_wide, expected);
        EXPECT_EQ(of_narrow, expected);
    });
}

TEST(GateLoops, NumbersHoldACountAndABoundedValue) {
    on_each_target([](std::size_t gates) {
        const auto codes = random_codes(gates, 2, 65535), others = random_codes(gates, 3, 65535);
        std::vector<std::uint32_t> found(gates), expected(gates);
        number_codes(codes.data(), gates, 14'000, found.data());
        std::ranges::transform(codes, expected.begin(), [](std::uint16_t code) {
            return code == 0 ? 0 : one_number + std::min<std::uint32_t>(code, 14'000);
        });
        EXPECT_EQ(found, expected);
        for (const std::int32_t turn : {100, 40'000, 1 << 20}) {
            number_differences(codes.data(), others.data(), gates, {turn, 440}, found.data());
            for (std::size_t i = 0; i < gates; ++i) {
                const int between = std::abs(codes[i] - others[i]);
                const int apart = std::min({between, std::abs(turn - between), 440});
                const auto square = static_cast<std::uint32_t>(apart * apart);
                expected[i] = codes[i] == 0 || others[i] == 0 ? 0 : one_number + square;
            }
            EXPECT_EQ(found, expected) << turn;
        }
    });
}

TEST(GateLoops, SumsOfWindowsAndOfRows) {
    on_each_target([](std::size_t gates) {
        for (const unsigned window : {1U, 3U, 7U, 33U, 81U}) {
            std::vector<std::uint32_t> numbers(gates + window - 1);
            std::mt19937 random(4);
            std::ranges::generate(numbers, [&] { return random() % 1000; });
            std::vector<std::uint32_t> expected(gates, 0), sums(gates), numbers_left = numbers;
            for (std::size_t gate = 0; gate < gates; ++gate)
                for (unsigned i = 0; i < window; ++i)
                    expected[gate] += numbers[gate + i];
            sum_windows(numbers_left.data(), gates, window, sums.data());
            EXPECT_EQ(sums, expected) << window;
            exchange_rows(numbers.data(), expected.data(), gates, sums.data());
            EXPECT_TRUE(std::ranges::equal(sums, std::span(numbers).first(gates)));
        }
    });
}

// A sum of nothing has no mean, and a share of 0.
TEST(GateLoops, FeaturesOfSumsAreThoseOfBoxSum) {
    on_each_target([](std::size_t gates) {
        std::mt19937 random(5);
        std::vector<std::uint32_t> sums(gates);
        std::ranges::generate(sums, [&] {
            const auto count = static_cast<std::uint32_t>(random() % 298);
            return count * one_number + count * static_cast<std::uint32_t>(random() % 140);
        });
        using Kind = SumFeature::Kind;
        for (const Kind kind : {Kind::mean, Kind::magnitude, Kind::root_mean, Kind::share}) {
            const SumFeature how{kind, 2.83F, 66, 297};
            std::vector<float> found(gates);
            features_of_sums(sums.data(), gates, how, found.data());
            for (std::size_t i = 0; i < gates; ++i) {
                const BoxSum sum(sums[i]);
                const float mean = (sum.mean() - 66) / 2.83F;
                const float expected = kind == Kind::mean        ? mean
                                       : kind == Kind::magnitude ? std::abs(mean)
                                       : kind == Kind::root_mean ? std::sqrt(sum.mean()) / 2.83F
                                                                 : sum.count() / 297;
                EXPECT_TRUE(found[i] == expected || (std::isnan(found[i]) && sums[i] == 0)) << i;
            }
        }
    });
}

TEST(GateLoops, EntriesAreThoseOfTheNearestStepAndOfNoValue) {
    constexpr std::array<float, 6> entries = {1, 2, 4, 8, 16, 32};  // the last is for NaN
    const StepTable table{-1, 2, 4, entries.data()};                // -1, -0.5, ... 1
    const std::array values = {-1.0F,
                               -9.0F,
                               -0.6F,
                               -0.4F,
                               0.1F,
                               0.9F,
                               99.0F,
                               std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::quiet_NaN()};
    constexpr std::array<float, 9> expected = {1, 1, 2, 2, 4, 16, 16, 16, 32};
    on_each_target([&](std::size_t gates) {
        std::vector<float> of_gates(gates), totals(gates, 100);
        for (std::size_t i = 0; i < gates; ++i)
            of_gates[i] = values.at(i % values.size());
        add_entries(of_gates.data(), gates, table, totals.data());
        for (std::size_t i = 0; i < gates; ++i)
            EXPECT_EQ(totals[i], 100 + expected.at(i % values.size())) << i;
    });
}

}  // namespace
}  // namespace stormcellar::retrieve
