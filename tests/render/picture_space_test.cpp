#include "render/map/picture_space.h"

#include <gtest/gtest.h>

#include "render/map/labels.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/render/render.h"

namespace stormcellar::render {
namespace {

constexpr std::pair<int, int> common_sizes[] = {
    {640, 480},   {796, 532},   {800, 600},   {1024, 768},  {1280, 720},
    {1920, 1080}, {2560, 1440}, {3840, 2160}, {1000, 1000}, {2048, 2048},
    {1080, 1350}, {1080, 1920}, {2160, 3840}, {720, 1280}};

LabelLayout layout_for(int width, int height, Product product) {
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.product = product;
    if (product == Product::section) scene.section = SectionLine{{35, -98}, {36, -97}};
    FrameFacts facts;
    facts.domain = "KTLX";
    facts.time = parse_compact("19990503_235621").value();
    facts.sites = {{"KTLX", 35.3, -97.3, 384}};
    return lay_out_labels(Fonts::load().value(), scene, facts, {legend_of(scene), 50e3, {}})
        .value();
}

// The map continues beyond the grid and fills its part of the picture, so this test measures that
// part.
TEST(PictureSpace, TheMapFillsMostOfTheFrame) {
    for (const auto& [width, height] : common_sizes) {
        const LabelLayout layout = layout_for(width, height, Product::composite);
        const double share = static_cast<double>(layout.width) * layout.height / width / height;
        EXPECT_GE(share, 0.7) << width << "x" << height;
        EXPECT_EQ(layout.left, 0);
    }
}

// Measures the map of a square grid in pixels of the picture.
TEST(PictureSpace, ASquareGridIsAsLargeAsTheFrameAllows) {
    const grid::GridSpec spec = grid::default_spec(35.3, -97.3);
    for (const auto& [width, height] : common_sizes) {
        const LabelLayout layout = layout_for(width, height, Product::composite);
        Scene scene;
        scene.product = Product::composite;
        const auto geometry = picture_geometry(spec, scene, layout.width, layout.height);
        const double side = 460e3 / geometry.metres_per_pixel();
        EXPECT_GE(side / std::min(width, height), 0.7) << width << "x" << height;
    }
}

TEST(PictureSpace, LettersGrowWithThePicture) {
    EXPECT_EQ(space_of(796, 532).scale, 1);
    for (const auto& [width, height] : common_sizes) {
        const PictureSpace one = space_of(width, height);
        const PictureSpace twice = space_of(2 * width, 2 * height);
        EXPECT_EQ(twice.shape, one.shape);
        if (one.scale > 0.85) {
            EXPECT_NEAR(twice.scale, 2 * one.scale, 1e-9);
        }
        // Small print, 8.5 pixels at scale 1, is at least a hundredth of the shorter side.
        EXPECT_GE(8.5 * one.scale / std::min(width, height), 0.01) << width << "x" << height;
    }
}

TEST(PictureSpace, HasThreeShapes) {
    EXPECT_EQ(space_of(1920, 1080).shape, PictureShape::wide);
    EXPECT_EQ(space_of(640, 480).shape, PictureShape::wide);
    EXPECT_EQ(space_of(1080, 1080).shape, PictureShape::square);
    EXPECT_EQ(space_of(1080, 1350).shape, PictureShape::square);
    EXPECT_EQ(space_of(1080, 1920).shape, PictureShape::tall);
    for (const auto& [width, height] : common_sizes) {
        const PictureSpace space = space_of(width, height);
        EXPECT_EQ(space.panel > 0, space.shape == PictureShape::wide);
        EXPECT_EQ(space.band > 0, space.shape != PictureShape::wide);
    }
}

TEST(PictureSpace, ASectionHasRoomForAMapOfItsLine) {
    for (const auto& [width, height] : common_sizes) {
        const LabelLayout layout = layout_for(width, height, Product::section);
        ASSERT_TRUE(layout.inset) << width << "x" << height;
        EXPECT_GE(layout.inset->width, 0.1 * std::min(width, height));
        EXPECT_GE(layout.inset->height, 0.1 * std::min(width, height));
        EXPECT_FALSE(layout_for(width, height, Product::composite).inset);
    }
}

}  // namespace
}  // namespace stormcellar::render
