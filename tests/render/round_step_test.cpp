#include "render/image/round_step.h"

#include <gtest/gtest.h>

#include "stormcellar/render/image.h"

namespace stormcellar::render {
namespace {

TEST(RoundStep, IsOneTwoOrFiveTimesAPowerOfTen) {
    EXPECT_DOUBLE_EQ(round_step(10, 10), 1);
    EXPECT_DOUBLE_EQ(round_step(11, 10), 2);
    EXPECT_DOUBLE_EQ(round_step(0.9, 4), 0.5);
    EXPECT_DOUBLE_EQ(round_step(6000, 10), 1000);
    EXPECT_DOUBLE_EQ(round_step(51, 10), 10);
}

TEST(Over, MixesByAlpha) {
    EXPECT_EQ(over({200, 100, 0, 255}, {0, 0, 100, 255}), (Rgba8{200, 100, 0, 255}));
    EXPECT_EQ(over({200, 100, 0, 0}, {0, 0, 100, 255}), (Rgba8{0, 0, 100, 255}));
    EXPECT_EQ(over({255, 100, 0, 51}, {0, 0, 100, 255}), (Rgba8{51, 20, 80, 255}));
}

}  // namespace
}  // namespace stormcellar::render
