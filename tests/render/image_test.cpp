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
    EXPECT_EQ(image.rgba[20], 9) << "the last pixel of the last row is last";
}

}  // namespace
}  // namespace stormcellar::render
