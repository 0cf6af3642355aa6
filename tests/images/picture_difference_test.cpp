#include "tests/images/picture_difference.h"

#include <gtest/gtest.h>

namespace stormcellar::images {
namespace {

using render::Image;
using render::Rgba8;

constexpr Rgba8 white{255, 255, 255, 255};
constexpr Rgba8 black{0, 0, 0, 255};

TEST(PictureDifference, OfTheSamePictureIsNothing) {
    const Image image(40, 30, {10, 200, 30, 255});
    const auto difference = difference_of(image, image);
    ASSERT_TRUE(difference);
    EXPECT_EQ(difference->percentile_99, 0);
    EXPECT_EQ(difference->visible_share, 0);
    EXPECT_EQ(difference->worst_tile, 0);
    EXPECT_TRUE(within(*difference));
}

TEST(PictureDifference, OfBlackAndWhiteIsAHundred) {
    const auto difference = difference_of(Image(40, 30, white), Image(40, 30, black));
    ASSERT_TRUE(difference);
    EXPECT_NEAR(difference->percentile_99, 100, 0.01);
    EXPECT_EQ(difference->visible_share, 1);
    EXPECT_NEAR(difference->worst_tile, 100, 0.01);
    EXPECT_FALSE(within(*difference));
}

// The changed block of 8 x 8 pixels (10 x 10 when softened) covers more of the tile at 40,24 than
// of any other tile.
TEST(PictureDifference, AFewPixelsInOnePlaceAreFoundThere) {
    Image other(160, 160, white);
    for (int y = 25; y < 33; ++y) {
        for (int x = 41; x < 49; ++x)
            other.set(x, y, black);
    }
    const auto difference = difference_of(Image(160, 160, white), other);
    ASSERT_TRUE(difference);
    EXPECT_EQ(difference->percentile_99, 0);
    EXPECT_DOUBLE_EQ(difference->visible_share, 100.0 / (160 * 160));
    EXPECT_GT(difference->worst_tile, 20);
    EXPECT_EQ(difference->tile_x, 40);
    EXPECT_EQ(difference->tile_y, 24);
    EXPECT_FALSE(within(*difference));
    const Image shown = picture_of_difference(Image(160, 160, white), other);
    EXPECT_GT(shown.at(44, 28)[0], shown.at(44, 28)[1] + 150) << "the difference is red";
    EXPECT_EQ(shown.at(100, 100), white);
}

TEST(PictureDifference, OfDifferentSizesThereIsNone) {
    const auto difference = difference_of(Image(40, 30, white), Image(30, 40, white));
    ASSERT_FALSE(difference);
    EXPECT_EQ(difference.error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(difference_of(Image{}, Image{}));
}

}  // namespace
}  // namespace stormcellar::images
