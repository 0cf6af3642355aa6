#include "stormcellar/render/scene.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"

namespace stormcellar::render {
namespace {

TEST(Product, NamesGoBothWays) {
    for (const ProductFacts& facts : all_products())
        EXPECT_EQ(product_from_name(product_name(facts.product)).value(), facts.product);
    EXPECT_FALSE(is_map(Product::volume));
    EXPECT_FALSE(is_map(Product::section));
    EXPECT_TRUE(is_map(Product::vil));
}

TEST(Product, UnknownNameListsTheKnownOnes) {
    const auto product = product_from_name("hologram");
    ASSERT_FALSE(product);
    EXPECT_EQ(product.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(product.error().message, ::testing::HasSubstr("volume, composite"));
}

TEST(Colors, AreTheScenesOrTheProductsOrTheMoments) {
    Scene scene;
    EXPECT_EQ(colors_of(scene).name, "nws-reflectivity");
    EXPECT_EQ(unit_shown(scene), "dBZ");
    scene.product = Product::echo_top;
    EXPECT_EQ(colors_of(scene).name, "nws-echo-top");
    EXPECT_EQ(unit_shown(scene), "km");
    scene.product = Product::highest_seen;
    EXPECT_EQ(colors_of(scene).name, "height");
    scene.product = Product::cappi;
    scene.moment = level2::Moment::rho;
    EXPECT_EQ(colors_of(scene).name, "nws-rho");
    scene.colors = find_color_table("safe-rho").value();
    EXPECT_EQ(colors_of(scene).name, "safe-rho");
    EXPECT_TRUE(validate(scene));
    scene.colors->unit.clear();
    scene.colors->moment = level2::Moment::ref;
    EXPECT_TRUE(validate(scene)) << "a table needs no unit";
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
        {"CAPPI", [](Scene& s) { s.cappi_height_m = 60001; }},
        {"threshold", [](Scene& s) { s.echo_top_dbz = NAN; }},
        {"two places", [](Scene& s) { s.product = Product::section; }},
        {"latitudes",
         [](Scene& s) {
             s.section = SectionLine{{91, 0}, {0, 0}};
         }},
        {"length of a section",
         [](Scene& s) {
             s.section = SectionLine{{35, -97}, {35, -97}};
         }},
        {"length of a section",
         [](Scene& s) {
             s.section = SectionLine{{35, -97}, {-35, 83}};
         }},
        {"echotop is made from reflectivity (REF), not from VEL",
         [](Scene& s) {
             s.product = Product::echo_top;
             s.moment = level2::Moment::vel;
         }},
        {"HCA has classes, which have no mean, so it is drawn as a ppi and not as volume",
         [](Scene& s) { s.moment = level2::Moment::hca; }},
        {"HCA has classes, which have no mean, so it is drawn as a ppi and not as composite",
         [](Scene& s) {
             s.product = Product::composite;
             s.moment = level2::Moment::hca;
         }},
        {"nws-velocity is in m/s, but the picture is in dBZ",
         [](Scene& s) { s.colors = find_color_table("nws-velocity").value(); }},
        {"nws-rho is without a unit, but the picture is in dBZ",
         [](Scene& s) { s.colors = find_color_table("nws-rho").value(); }},
        {"do not rise",
         [](Scene& s) {
             s.colors = nws_reflectivity();
             s.colors->stops[2].from = -99;
         }},
    };
    for (const Case& c : cases) {
        Scene scene;
        c.spoil(scene);
        const Status status = validate(scene);
        ASSERT_FALSE(status) << c.name;
        EXPECT_EQ(status.error().code, ErrorCode::bad_argument);
        EXPECT_THAT(status.error().message, ::testing::HasSubstr(c.name));
    }
}

}  // namespace
}  // namespace stormcellar::render
