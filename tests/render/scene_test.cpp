#include "render/scene.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

TEST(Product, NamesGoBothWays) {
    for (const Product product : {Product::volume, Product::composite}) {
        EXPECT_EQ(product_from_name(product_name(product)).value(), product);
    }
}

TEST(Product, UnknownNameListsTheKnownOnes) {
    const auto product = product_from_name("hologram");
    ASSERT_FALSE(product);
    EXPECT_EQ(product.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(product.error().message, testing::HasSubstr("volume, composite"));
}

TEST(SceneValidation, AcceptsTheDefault) {
    EXPECT_TRUE(validate(Scene{}));
}

TEST(SceneValidation, NamesTheFieldThatIsOutOfRange) {
    struct Case {
        const char* name;
        std::function<void(Scene&)> spoil;
    };
    const std::vector<Case> cases = {
        {"width", [](Scene& s) { s.width = 15; }},
        {"height", [](Scene& s) { s.height = 8193; }},
        {"azimuth", [](Scene& s) { s.camera.azimuth_deg = INFINITY; }},
        {"tilt", [](Scene& s) { s.camera.tilt_deg = 90.5; }},
        {"zoom", [](Scene& s) { s.camera.zoom = 0; }},
        {"slices", [](Scene& s) { s.slices = 7; }},
        {"exaggeration", [](Scene& s) { s.vertical_exaggeration = NAN; }},
        {"opacity", [](Scene& s) { s.opacity = 0; }},
        {"ring", [](Scene& s) { s.range_ring_spacing_m = 1; }},
    };
    for (const Case& c : cases) {
        Scene scene;
        c.spoil(scene);
        const Status status = validate(scene);
        ASSERT_FALSE(status) << c.name;
        EXPECT_EQ(status.error().code, ErrorCode::bad_argument);
        EXPECT_THAT(status.error().message, testing::HasSubstr(c.name));
    }
}

}  // namespace
}  // namespace stormcellar::render
