#include "render/color/color_difference.h"

#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

struct Pair {
    Lab one, other;
    double difference;
};

// Table 1 of Sharma, Wu, Dalal (2005), all 34 pairs, which cover every branch of the formula.
constexpr Pair published[] = {
    {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
    {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
    {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
    {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
    {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
    {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
    {{50, 0, 0}, {50, -1, 2}, 2.3669},
    {{50, -1, 2}, {50, 0, 0}, 2.3669},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0010}, 7.1792},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0012}, 7.2195},
    {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
    {{50, -0.0010, 2.4900}, {50, 0.0010, -2.4900}, 4.8045},
    {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
    {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
    {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
    {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
    {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
    {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
    {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
    {{50, 2.5, 0}, {50, 3.2972, 0}, 1.0000},
    {{50, 2.5, 0}, {50, 1.8634, 0.5757}, 1.0000},
    {{50, 2.5, 0}, {50, 3.2592, 0.3350}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

TEST(Ciede2000, AgreesWithThe34PublishedPairsEitherWayRound) {
    static_assert(std::size(published) == 34);
    for (const Pair& pair : published) {
        EXPECT_NEAR(ciede2000(pair.one, pair.other), pair.difference, 5.1e-5);
        EXPECT_NEAR(ciede2000(pair.other, pair.one), pair.difference, 5.1e-5);
        EXPECT_EQ(ciede2000(pair.one, pair.one), 0);
    }
}

// Two grays differ only in lightness. Their difference is computed by hand: at a mean lightness of
// 50, as from black to white, the divisor is 1.
TEST(Ciede2000, BlackAndWhiteAreAHundredApart) {
    EXPECT_NEAR(color_difference({0, 0, 0, 255}, {255, 255, 255, 255}), 100, 1e-9);
    EXPECT_NEAR(ciede2000({45, 0, 0}, {55, 0, 0}), 10, 1e-12);
}

TEST(Lab, GreysAreNeutralAndTheLimitsAreThoseOfTheScale) {
    for (int grey = 0; grey < 256; grey += 5) {
        const auto v = static_cast<std::uint8_t>(grey);
        const Lab lab = lab_of({v, v, v, 255});
        EXPECT_NEAR(lab.a, 0, 1e-12);
        EXPECT_NEAR(lab.b, 0, 1e-12);
    }
    EXPECT_NEAR(lab_of({0, 0, 0, 255}).lightness, 0, 1e-12);
    EXPECT_NEAR(lab_of({255, 255, 255, 255}).lightness, 100, 1e-12);
    // 119 is the gray whose lightness is about 50: ((119/255 + 0.055)/1.055)^2.4 = 0.18447.
    EXPECT_NEAR(linear_of(119), 0.184475, 1e-6);
    EXPECT_NEAR(lab_of({119, 119, 119, 255}).lightness, 116 * std::cbrt(0.184475) - 16, 1e-4);
}

// The primary red has X = 41.24, Y = 21.26, Z = 1.93 (of 100).
TEST(Lab, OfTheRedPrimary) {
    const Lab red = lab_of({255, 0, 0, 0});
    EXPECT_NEAR(red.lightness, 116 * std::cbrt(0.2126) - 16, 1e-9);
    EXPECT_NEAR(red.a, 500 * (std::cbrt(0.4124 / 0.9505) - std::cbrt(0.2126)), 1e-9);
    EXPECT_NEAR(red.b, 200 * (std::cbrt(0.2126) - std::cbrt(0.0193 / 1.0890)), 1e-9);
}

TEST(ImageDifference, EqualPicturesDoNotDiffer) {
    const Image image(20, 10, {12, 200, 77, 255});
    const auto none = image_difference(image, image);
    ASSERT_TRUE(none);
    EXPECT_EQ(none->pixels, 200U);
    EXPECT_EQ(none->unequal, 0U);
    EXPECT_EQ(none->mean, 0);
    EXPECT_EQ(none->max, 0);
}

// Three of 200 pixels differ. The 99th percentile leaves out the two largest differences.
TEST(ImageDifference, SummarisesMeanPercentileAndLargest) {
    const Rgba8 base = {0, 0, 0, 255};
    const Image one(20, 10, base);
    Image other = one;
    other.set(0, 0, {255, 255, 255, 255});
    other.set(5, 5, {100, 100, 100, 255});
    other.set(19, 9, {50, 50, 50, 0});
    const double small = color_difference(base, {50, 50, 50, 255});
    const double middle = color_difference(base, {100, 100, 100, 255});
    const auto summary = image_difference(one, other);
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->unequal, 3U);
    EXPECT_NEAR(summary->mean, (100 + small + middle) / 200, 1e-12);
    EXPECT_NEAR(summary->max, 100, 1e-9);
    EXPECT_EQ(summary->percentile_99, small);
    other.set(19, 9, base);
    EXPECT_EQ(image_difference(one, other)->percentile_99, 0);
}

TEST(ImageDifference, RefusesPicturesOfDifferentSizes) {
    const auto refused = image_difference(Image(2, 3, {}), Image(3, 2, {}));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(image_difference(Image{}, Image{}));
}

}  // namespace
}  // namespace stormcellar::render
