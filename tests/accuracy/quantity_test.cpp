#include "stormcellar/accuracy/quantity.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/accuracy/infinity.h"

namespace stormcellar::accuracy {
namespace {

TEST(Quantity, NumbersHaveThreeDigitsAndNoExponentWhereTheyAreRead) {
    EXPECT_EQ(format_number(0), "0");
    EXPECT_EQ(format_number(250), "250");
    EXPECT_EQ(format_number(0.5), "0.5");
    EXPECT_EQ(format_number(0.3), "0.3");
    EXPECT_EQ(format_number(3795), "3800");
    EXPECT_EQ(format_number(123456), "124000");
    EXPECT_EQ(format_number(0.00012), "0.00012");
    EXPECT_EQ(format_number(2e-9), "2e-09");
    EXPECT_EQ(format_number(1e30), "1e+30");
    EXPECT_EQ(format_number(infinity), "unbounded");
}

TEST(Quantity, NoErrorLooksSmallerThanItIs) {
    EXPECT_EQ(format_number(250.4), "251");
    EXPECT_EQ(format_number(999.1), "1000");
    EXPECT_EQ(format_number(0.50001), "0.501");
    std::mt19937_64 random(20261121);
    std::uniform_real_distribution<double> exponent(-4, 7);
    for (int i = 0; i < 100000; ++i) {
        const double number = std::pow(10, exponent(random));
        const double written = std::stod(format_number(number));
        EXPECT_GE(written, number * (1 - 1e-11)) << number;
        EXPECT_LE(written, number * 1.0101) << number;
    }
}

TEST(Quantity, AnyPositiveNumberCanBeWritten) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> exponent(-307, 308);
    for (int i = 0; i < 20000; ++i) {
        const double number = std::pow(10, exponent(random));
        EXPECT_NEAR(std::stod(format_number(number)) / number, 1, 0.011) << number;
    }
    EXPECT_FALSE(format_number(std::numeric_limits<double>::denorm_min()).empty());
    EXPECT_FALSE(format_number(std::numeric_limits<double>::max()).empty());
}

TEST(Quantity, SizesNameTheirUnits) {
    EXPECT_EQ(format_size({412, 0.2, 0}, ValueUnit::db), "412 m, 0.2 dB");
    EXPECT_EQ(format_size({0, 0.2, 1.5}, ValueUnit::mps), "0.2 m/s, dE 1.5");
    EXPECT_EQ(format_size({}, ValueUnit::db), "0");
    EXPECT_EQ(format_size({infinity, 0, 0}, ValueUnit::db), "unbounded");
}

TEST(Quantity, TimesAreWrittenInTheUnitThatSuitsThem) {
    EXPECT_EQ(format_seconds(0), "0 s");
    EXPECT_EQ(format_seconds(3.1e-6), "3.1 us");
    EXPECT_EQ(format_seconds(0.02), "20 ms");
    EXPECT_EQ(format_seconds(1.25), "1.25 s");
}

TEST(Quantity, SizesAddUpQuantityByQuantity) {
    ErrorSize sum{1, 2, 3};
    sum += {10, 20, 30};
    EXPECT_EQ(sum, (ErrorSize{11, 22, 33}));
    EXPECT_EQ(sum.of(Quantity::position), 11);
    EXPECT_EQ(sum.of(Quantity::value), 22);
    EXPECT_EQ(sum.of(Quantity::image), 33);
}

}  // namespace
}  // namespace stormcellar::accuracy
