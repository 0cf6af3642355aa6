#include "stormcellar/accuracy/budget.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::accuracy {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& text) {
    const auto budget = parse_budget(text);
    if (budget) return "no error";
    EXPECT_EQ(budget.error().code, ErrorCode::bad_argument);
    EXPECT_EQ(budget.error().message.find('\n'), std::string::npos);
    return budget.error().message;
}

Budget parsed(const std::string& text) {
    const auto budget = parse_budget(text);
    EXPECT_TRUE(budget) << text << ": " << error_of(text);
    return budget.value_or(Budget{});
}

TEST(Budget, ReadsTheFormsOfTheManual) {
    const Budget errors = parsed("250 m, 0.5 dB");
    EXPECT_EQ(errors.position_m, 250);
    EXPECT_EQ(errors.value, 0.5);
    EXPECT_EQ(errors.value_unit, ValueUnit::db);
    EXPECT_FALSE(errors.image_de || errors.time_s);
    EXPECT_EQ(parsed("0.5 dB,250m"), errors);
    EXPECT_EQ(parsed("  0.25 km ,\t0.5 DB "), errors);

    EXPECT_EQ(parsed("dE 2").image_de, 2);
    EXPECT_EQ(parsed("2 dE").image_de, 2);
    EXPECT_EQ(parsed("20 ms").time_s, 0.02);
    EXPECT_EQ(parsed("1 s").time_s, 1);
    const Budget velocity = parsed("0.5 m/s, 1 s");
    EXPECT_EQ(velocity.value, 0.5);
    EXPECT_EQ(velocity.value_unit, ValueUnit::mps);
    EXPECT_EQ(velocity.time_s, 1);
    EXPECT_EQ(parsed("2 deg").value_unit, ValueUnit::degree);
    EXPECT_EQ(parsed("0.01 ratio").value, 0.01);
    EXPECT_EQ(parsed("0.01 Ratio").value_unit, ValueUnit::ratio);
    EXPECT_THAT(error_of("2 deg, 1 dB"), HasSubstr("already has a value error"));
}

TEST(Budget, AnErrorOfZeroMeansExactATimeOfZeroNothing) {
    EXPECT_EQ(parsed("0 m").position_m, 0);
    EXPECT_EQ(parsed("0 dB").value, 0);
    EXPECT_EQ(parsed("dE 0").image_de, 0);
    EXPECT_THAT(error_of("0 s"), HasSubstr("above zero"));
    EXPECT_THAT(error_of("250 m, 1e-330 ms"), HasSubstr("1e-330 ms"));
}

TEST(Budget, NamesWhatWasNotUnderstood) {
    EXPECT_THAT(error_of(""), HasSubstr("empty"));
    EXPECT_THAT(error_of(" \t"), HasSubstr("empty"));
    EXPECT_THAT(error_of("250 m,"), HasSubstr("\"\" in the budget"));
    EXPECT_THAT(error_of(",250 m"), HasSubstr("\"\" in the budget"));
    EXPECT_THAT(error_of("250 m, soon"), HasSubstr("\"soon\""));
    EXPECT_THAT(error_of("250"), HasSubstr("\"250\" in the budget has no unit"));
    EXPECT_THAT(error_of("250 feet"), HasSubstr("\"250 feet\" in the budget has an unknown unit"));
    EXPECT_THAT(error_of("0,5 dB"), HasSubstr("\"0\" in the budget has no unit"));
    EXPECT_THAT(error_of("dE 2 3"), HasSubstr("has an unknown word, \"3\""));
    EXPECT_THAT(error_of("dE"), HasSubstr("\"dE\""));
    EXPECT_THAT(error_of("0x10 m"), HasSubstr("unknown unit"));
    EXPECT_THAT(error_of("250 m 0.5 dB"), HasSubstr("\"250 m 0.5 dB\""));
}

TEST(Budget, RefusesWhatIsNoMagnitude) {
    for (const char* text : {"-1 m", "-0 m", "nan m", "-nan dB", "inf m", "dE -2", "dE nan",
                             "1e999 m", "-5 ms", "infinity s"}) {
        EXPECT_THAT(error_of(text), HasSubstr("finite number and not negative")) << text;
    }
    EXPECT_THAT(error_of("1e308 km"), HasSubstr("too large"));
}

TEST(Budget, TakesEachQuantityOnce) {
    EXPECT_THAT(error_of("1 m, 2 km"),
                HasSubstr("\"2 km\": the budget already has a position error"));
    EXPECT_THAT(error_of("1 dB, 2 m/s"), HasSubstr("already has a value error"));
    EXPECT_THAT(error_of("dE 1, 2 dE"), HasSubstr("already has a color error"));
    EXPECT_THAT(error_of("1 s, 20 ms"), HasSubstr("already has a time"));
}

TEST(Budget, HostileTextIsRefusedInOneShortLine) {
    EXPECT_THAT(error_of(std::string(100000, '9')), HasSubstr("longer than 200"));
    EXPECT_THAT(error_of(std::string("5 m\n\x1b[2J")), HasSubstr("\\x1b"));
    EXPECT_THAT(error_of(std::string("5\0 m", 4)), HasSubstr("\\x00"));
    std::mt19937_64 random(1);
    const std::string letters = "0123456789.eE+-, mkdBs/dE\t\n\x80\xff";
    for (int i = 0; i < 100000; ++i) {
        std::string text;
        for (std::size_t n = random() % 24; n > 0; --n)
            text += letters[random() % letters.size()];
        const auto budget = parse_budget(text);
        if (!budget) {
            EXPECT_EQ(budget.error().message.find('\n'), std::string::npos);
            continue;
        }
        for (const auto& part :
             {budget->position_m, budget->value, budget->image_de, budget->time_s}) {
            EXPECT_TRUE(!part || (std::isfinite(*part) && *part >= 0)) << text;
        }
        EXPECT_TRUE(budget->bounds_errors() || budget->time_s) << text;
        EXPECT_EQ(parsed(format_budget(*budget)), *budget) << text;
    }
}

TEST(Budget, WhatIsWrittenIsReadBackToTheBit) {
    std::mt19937_64 random(20261121);
    std::uniform_real_distribution<double> exponent(-300, 300);
    const auto maybe = [&]() -> std::optional<double> {
        if (random() % 2 == 0) return std::nullopt;
        return std::pow(10, exponent(random));
    };
    for (int i = 0; i < 20000; ++i) {
        Budget budget{maybe(), maybe(), ValueUnit::db, maybe(), maybe()};
        if (budget.value) budget.value_unit = static_cast<ValueUnit>(random() % 4);
        if (!budget.bounds_errors() && !budget.time_s) continue;
        EXPECT_EQ(parsed(format_budget(budget)), budget) << format_budget(budget);
    }
}

}  // namespace
}  // namespace stormcellar::accuracy
