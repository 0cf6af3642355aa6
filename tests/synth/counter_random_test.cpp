#include "synth/counter_random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::synth {
namespace {

// Compares the numbers with the published answers for the generator (Random123, kat_vectors).
TEST(CounterRandom, GivesThePublishedAnswers) {
    EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}),
              (RandomWords{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    constexpr std::uint32_t ones = 0xffffffff;
    EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}),
              (RandomWords{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (RandomWords{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(CounterRandom, UniformNumbersStayInsideTheirEnds) {
    EXPECT_GT(uniform_of(0), 0);
    EXPECT_LT(uniform_of(0xffffffff), 1);
    EXPECT_LT(std::abs(normals_of(0, 0).first), 6.8);
}

// Numbers of neighboring places, seeds and purposes are uncorrelated.
TEST(CounterRandom, NormalNumbersHaveTheirMomentsAndDoNotHangTogether) {
    constexpr int side = 400;
    const auto normal = [](std::uint32_t seed, Draw purpose, DrawPlace place) {
        const RandomWords words = draw(seed, purpose, place);
        return normals_of(words[0], words[1]);
    };
    double sum = 0;
    double squares = 0;
    double fourths = 0;
    double pairs[7] = {};
    for (std::uint32_t radial = 0; radial < side; ++radial) {
        for (std::uint32_t gate = 0; gate < side; ++gate) {
            const NormalPair own = normal(7, Draw::gate, {1, 2, radial, gate});
            const double x = own.first;
            sum += x;
            squares += x * x;
            fourths += x * x * x * x;
            pairs[0] += x * own.second;
            pairs[1] += x * normal(7, Draw::gate, {1, 2, radial, gate + 1}).first;
            pairs[2] += x * normal(7, Draw::gate, {1, 2, radial + 1, gate}).first;
            pairs[3] += x * normal(7, Draw::gate, {1, 3, radial, gate}).first;
            pairs[4] += x * normal(7, Draw::gate, {2, 2, radial, gate}).first;
            pairs[5] += x * normal(8, Draw::gate, {1, 2, radial, gate}).first;
            pairs[6] += x * normal(7, Draw::missing, {1, 2, radial, gate}).first;
        }
    }
    constexpr double count = side * side;
    // Each tolerance is four standard errors.
    EXPECT_NEAR(sum / count, 0, 4 / std::sqrt(count));
    EXPECT_NEAR(squares / count, 1, 4 * std::sqrt(2 / count));
    EXPECT_NEAR(fourths / count, 3, 4 * std::sqrt(96 / count));
    for (const double pair : pairs)
        EXPECT_NEAR(pair / count, 0, 4 / std::sqrt(count));
}

}  // namespace
}  // namespace stormcellar::synth
