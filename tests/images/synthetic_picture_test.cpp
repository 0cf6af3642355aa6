// Compares pictures of synthetic grids with stored references, and tests that errors are found.
// Most tests below change the scene or the drawn pixels, and every picture that the change concerns
// must then exceed the tolerance.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "render/image/canvas.h"
#include "render/map/labels.h"
#include "tests/images/picture_difference.h"
#include "tests/images/reference_check.h"
#include "tests/images/synthetic_pictures.h"
#include "tests/testing/test_name.h"

namespace stormcellar::images {
namespace {

using render::Image;
using render::Rgba8;

class SyntheticPicture : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override { picture_ = make_picture(GetParam()); }

    // Returns true if the picture differs from its reference, or could not be drawn.
    [[nodiscard]] static bool found(const Result<Image>& drawn) {
        if (!drawn) return true;
        const auto difference = difference_of(*drawn, read_reference(GetParam()).value());
        return !difference || !within(*difference);
    }

    Picture picture_;
};

// Tests the pictures with a camera. The next classes test pictures with text around them, and
// pictures with a map.
class CameraPicture : public SyntheticPicture {};
class LabelledPicture : public SyntheticPicture {};
class SitePicture : public SyntheticPicture {};

std::string name_of(const ::testing::TestParamInfo<std::string>& instance) {
    return testing::test_name(instance.param);
}

INSTANTIATE_TEST_SUITE_P(All, SyntheticPicture, ::testing::ValuesIn(picture_names()), name_of);
INSTANTIATE_TEST_SUITE_P(All, CameraPicture,
                         ::testing::Values("volume-perspective", "volume-lit", "ground-not-seen"),
                         name_of);
INSTANTIATE_TEST_SUITE_P(All, LabelledPicture,
                         ::testing::Values("volume-perspective", "composite", "cappi-velocity",
                                           "section", "echo-tops"),
                         name_of);
INSTANTIATE_TEST_SUITE_P(All, SitePicture,
                         ::testing::Values("volume-perspective", "composite", "cappi-velocity",
                                           "echo-tops"),
                         name_of);

TEST_P(SyntheticPicture, LooksAsItsReference) {
    const auto drawn = draw(picture_);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_TRUE(matches_reference(*drawn, GetParam()));
}

// Mixes each pixel with its neighbor to the right and adds noise, like letters drawn by another
// library. The picture must stay within the tolerance.
TEST_P(SyntheticPicture, OtherLettersAreTolerated) {
    Image image = read_reference(GetParam()).value();
    const Image original = image;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x + 1 < image.width; ++x) {
            Rgba8 pixel = original.at(x, y);
            const Rgba8 next = original.at(x + 1, y);
            for (std::size_t i = 0; i < 3; ++i) {
                const double mixed = 0.9 * pixel[i] + 0.1 * next[i] + (x * 7 + y * 3) % 3 - 1;
                pixel[i] = static_cast<std::uint8_t>(std::lround(std::clamp(mixed, 0.0, 255.0)));
            }
            image.set(x, y, pixel);
        }
    }
    EXPECT_FALSE(found(image));
}

TEST_P(SyntheticPicture, AMirroredGridIsFound) {
    mirror(picture_.grid);
    EXPECT_TRUE(found(draw(picture_)));
}

// Exchanges classes of the table that occur in every one of these pictures.
TEST_P(SyntheticPicture, TwoExchangedColorsAreFound) {
    const std::size_t classes = render::colors_of(picture_.scene).stops.size();
    const std::size_t first = picture_.scene.product == render::Product::cappi ? classes / 2 : 3;
    swap_classes(picture_.scene, first);
    EXPECT_TRUE(found(draw(picture_)));
}

TEST_P(CameraPicture, ADegreeOfAzimuthIsFound) {
    picture_.scene.camera.azimuth_deg += 1;
    EXPECT_TRUE(found(draw(picture_)));
}

TEST_P(CameraPicture, ADegreeOfTiltIsFound) {
    picture_.scene.camera.tilt_deg += 1;
    EXPECT_TRUE(found(draw(picture_)));
}

// Turns the pixels about the middle of the picture, because maps and sections have no camera to
// turn.
TEST_P(SyntheticPicture, APictureTurnedByADegreeIsFound) {
    const Image original = read_reference(GetParam()).value();
    Image image = original;
    const double turn = std::numbers::pi / 180;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double dx = x - 0.5 * image.width;
            const double dy = y - 0.5 * image.height;
            const auto from_x =
                std::lround(0.5 * image.width + dx * std::cos(turn) - dy * std::sin(turn));
            const auto from_y =
                std::lround(0.5 * image.height + dx * std::sin(turn) + dy * std::cos(turn));
            image.set(x, y,
                      original.at(std::clamp(static_cast<int>(from_x), 0, image.width - 1),
                                  std::clamp(static_cast<int>(from_y), 0, image.height - 1)));
        }
    }
    EXPECT_TRUE(found(image));
}

TEST_P(SyntheticPicture, AMoveByAPixelIsFound) {
    const Image original = read_reference(GetParam()).value();
    Image image = original;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 1; x < image.width; ++x)
            image.set(x, y, original.at(x - 1, y));
    }
    EXPECT_TRUE(found(image));
}

// If a site moves, its rings, its mark and its name move, too.
TEST_P(SitePicture, ASiteThatMovedIsFound) {
    picture_.facts.sites[0].latitude_deg += 0.05;
    EXPECT_TRUE(found(draw(picture_)));
}

TEST_P(LabelledPicture, AnotherTimeIsFound) {
    picture_.facts.time += std::chrono::seconds(240);
    EXPECT_TRUE(found(draw(picture_)));
}

TEST_P(LabelledPicture, AWrongUnitIsFound) {
    picture_.scene.colors = render::colors_of(picture_.scene);
    picture_.scene.colors->unit = "kt";
    EXPECT_TRUE(found(draw(picture_)));
}

// Moves each text around the picture by three pixels in the reference itself.
TEST_P(LabelledPicture, EachLabelThatMovedIsFound) {
    const auto fonts = render::Fonts::load();
    ASSERT_TRUE(fonts) << fonts.error().message;
    render::Legend legend = render::legend_of(picture_.scene);
    legend.table = &render::colors_of(picture_.scene);
    const auto layout =
        render::lay_out_labels(*fonts, picture_.scene, picture_.facts, {legend, 50e3, {}});
    ASSERT_TRUE(layout) << layout.error().message;
    const Image original = read_reference(GetParam()).value();
    EXPECT_GT(layout->texts.size(), 10U);
    for (const render::LabelText& text : layout->texts) {
        Image image = original;
        const int top = std::max(0, static_cast<int>(text.box.y));
        const int bottom = std::min(image.height, static_cast<int>(text.box.bottom()) + 1);
        const int left = std::max(3, static_cast<int>(text.box.x));
        const int right = std::min(image.width, static_cast<int>(text.box.right()) + 3);
        for (int y = top; y < bottom; ++y) {
            for (int x = left; x < right; ++x)
                image.set(x, y, original.at(x - 3, y));
        }
        EXPECT_TRUE(found(image)) << text.text;
    }
}

}  // namespace
}  // namespace stormcellar::images
