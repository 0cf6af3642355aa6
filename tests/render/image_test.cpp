#include "stormcellar/render/image.h"

#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

TEST(Image, IsFilledAndRowZeroComesFirst) {
    Image image(3, 2, {1, 2, 3, 255});
    image.set(2, 1, {9, 8, 7, 6});
    EXPECT_EQ(image.at(0, 0), (Rgba8{1, 2, 3, 255}));
    EXPECT_EQ(image.at(2, 1), (Rgba8{9, 8, 7, 6}));
    ASSERT_EQ(image.rgba.size(), 24U);
    EXPECT_EQ(image.rgba[20], 9) << "rows are stored from the top down";
}

TEST(Over, AnOpaqueColorHidesWhatIsBelow) {
    const Rgba8 below = {40, 44, 50, 255};
    EXPECT_EQ(over({200, 3, 90, 255}, below), (Rgba8{200, 3, 90, 255}));
    EXPECT_EQ(over({200, 3, 90, 0}, below), below);
    EXPECT_EQ(over({200, 4, 90, 51}, below), (Rgba8{72, 36, 58, 255}))
        << "the color is a fifth of the way";
}

}  // namespace
}  // namespace stormcellar::render
