#include "stormcellar/render/product.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/image/shades.h"
#include "render/map/legend.h"
#include "render/products/flat_field.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

Scene scene_of(Product product, Moment moment) {
    Scene scene;
    scene.product = product;
    scene.moment = moment;
    return scene;
}

std::vector<std::string> legend_texts(const Scene& scene) {
    std::vector<std::string> texts;
    const Legend legend = legend_of(scene);
    for (const LegendRow& row : legend.rows)
        texts.push_back(row.text);
    return texts;
}

TEST(ProductTitle, NamesMomentAndProduct) {
    EXPECT_EQ(product_title(scene_of(Product::volume, Moment::ref)), "Reflectivity, 3D volume");
    EXPECT_EQ(product_title(scene_of(Product::composite, Moment::ref)),
              "Composite reflectivity (column maximum)");
    Scene cappi = scene_of(Product::cappi, Moment::rho);
    cappi.cappi_height_m = 2500;
    EXPECT_EQ(product_title(cappi), "Correlation coefficient at 2.5 km above sea level (CAPPI)");
    EXPECT_EQ(product_title(scene_of(Product::section, Moment::vel)),
              "Radial velocity, vertical section");
    EXPECT_EQ(product_title(scene_of(Product::echo_top, Moment::ref)), "Echo tops, 18.5 dBZ");
    Scene hail = scene_of(Product::mesh, Moment::ref);
    EXPECT_EQ(product_title(hail),
              "Maximum expected size of hail (MESH), assuming 0 C at 4.2 km and -20 C at 7.3 km");
    hail.units.height = Unit::kft;
    EXPECT_THAT(product_title(hail), ::testing::EndsWith("0 C at 13.8 kft and -20 C at 24 kft"));
}

TEST(ProductLegend, SaysWhatIsNotInTheColorBar) {
    using ::testing::ElementsAre;
    EXPECT_THAT(legend_texts(scene_of(Product::cappi, Moment::ref)),
                ElementsAre("no echo or < 5 dBZ", "range folded", "not seen"));
    EXPECT_THAT(legend_texts(scene_of(Product::cappi, Moment::vel)),
                ElementsAre("no echo", "range folded", "not seen"));
    EXPECT_THAT(legend_texts(scene_of(Product::cappi, Moment::phi)),
                ElementsAre("no echo", "range folded", "not seen"));
    EXPECT_THAT(legend_texts(scene_of(Product::section, Moment::rho)),
                ElementsAre("no echo or < 0.2", "range folded", "not seen"));
    EXPECT_THAT(
        legend_texts(scene_of(Product::echo_top, Moment::ref)),
        ElementsAre("dotted: at least", "no echo or < 18.5 dBZ", "range folded", "not seen"));
    EXPECT_THAT(legend_texts(scene_of(Product::ppi, Moment::veld)),
                ElementsAre("no echo", "range folded", "ambiguous", "not seen"));
    EXPECT_THAT(legend_texts(scene_of(Product::lowest_seen, Moment::ref)), ElementsAre("not seen"));
}

// With haze, all seen ground has one shade, whatever its lowest beam, so the legend explains the
// air.
TEST(ProductLegend, OfAHazyVolumeIsOfTheAir) {
    using ::testing::ElementsAre;
    Scene scene = scene_of(Product::volume, Moment::ref);
    EXPECT_THAT(legend_texts(scene), ElementsAre("seen below 3 km", "seen above 3 km", "not seen"));
    scene.haze = true;
    EXPECT_THAT(legend_texts(scene), ElementsAre("air seen", "air not seen", "nothing seen"));
    const Rgba8 hazy = legend_of(scene).rows[1].color;
    EXPECT_GT(hazy[0], shades::dark.land.seen[0]);
    EXPECT_LT(hazy[0], shades::dark.haze[0]);
}

// The swatch looks like ambiguous gates in the picture (render/products/ground.h).
TEST(ProductLegend, HatchesAmbiguousInTheColorOfRangeFolded) {
    const Scene scene = scene_of(Product::composite, Moment::veld);
    const Legend legend = legend_of(scene);
    const auto row = std::ranges::find(legend.rows, "ambiguous", &LegendRow::text);
    ASSERT_NE(row, legend.rows.end());
    EXPECT_EQ(row->color, shades::dark.land.seen);
    EXPECT_EQ(row->lines, colors_of(scene).range_folded);
    const Legend volume = legend_of(scene_of(Product::volume, Moment::veld));
    EXPECT_EQ(volume.notes.front(), "no echo, ambiguous")
        << "a volume does not show ambiguous echo";
}

TEST(BarHeading, IsTheUnitOrElseTheMoment) {
    EXPECT_EQ(legend_of(scene_of(Product::volume, Moment::vel)).bar_heading, "m/s");
    EXPECT_EQ(legend_of(scene_of(Product::volume, Moment::rho)).bar_heading, "RHO");
    EXPECT_EQ(legend_of(scene_of(Product::vil, Moment::ref)).bar_heading, "kg/m2");
}

TEST(MapField, IsTheScenesProduct) {
    const auto bricks = bricks_of(
        make_grid_of(small_spec(3, 4), [](int, int, int iz) { return valued(40 - 10 * iz); }));
    const auto view = bricks.view();
    const auto columns = summarize_columns(view, 1);
    const FrameFacts facts{"KTLX", Moment::ref, UtcTime{}, {}, false};
    Scene scene = scene_of(Product::composite, Moment::ref);
    EXPECT_EQ(map_field(view, facts, scene, columns, 1)->values[4], 40);
    scene.product = Product::cappi;
    scene.cappi_height_m = 1000;
    EXPECT_EQ(map_field(view, facts, scene, columns, 1)->values[4], 30);
    scene.product = Product::echo_top;
    scene.echo_top_dbz = 25;
    EXPECT_EQ(map_field(view, facts, scene, columns, 1)->values[4], 1.25F);
    scene.product = Product::highest_seen;
    EXPECT_EQ(map_field(view, facts, scene, columns, 1)->values[4], 2);
    scene.product = Product::mesh;
    scene.freezing_levels = {200, 1300};
    EXPECT_EQ(map_field(view, facts, scene, columns, 1)->status[4], grid::CellStatus::no_echo)
        << "40 dBZ make no hail";
    scene.freezing_levels = {1300, 200};
    EXPECT_FALSE(validate(scene));
    scene.product = Product::volume;
    EXPECT_FALSE(map_field(view, facts, scene, columns, 1));
}

TEST(MapField, OfRotationIsALayerAboveTheLowestRadar) {
    const auto bricks = bricks_of(
        make_grid_of(small_spec(3, 20), [](int, int, int iz) { return valued(40 - 2 * iz); }));
    const auto view = bricks.view();
    FrameFacts facts{"KTLX", Moment::azsh, UtcTime{}, {{"KTLX", 35, -97, 370}}, false};
    Scene scene = scene_of(Product::rotation, Moment::azsh);
    EXPECT_TRUE(validate(scene));
    EXPECT_EQ(map_field(view, facts, scene, {}, 1)->values[4], 40);
    scene.product = Product::rotation_aloft;
    EXPECT_EQ(map_field(view, facts, scene, {}, 1)->values[4], 28) << "at 3.5 km above sea level";
    facts.sites.push_back({"KFDR", 34, -99, 1400});
    EXPECT_EQ(map_field(view, facts, scene, {}, 1)->values[4], 28) << "above KTLX";
    facts.sites.front().altitude_m = 1370;
    EXPECT_EQ(map_field(view, facts, scene, {}, 1)->values[4], 24) << "at 4.5 km";
    scene.moment = Moment::vel;
    EXPECT_EQ(validate(scene).error().message, "rotation-aloft is made from AZSH, not from VEL");
}

TEST(Legend, OfClassesHasTheirNamesInPlaceOfTheBar) {
    const Scene scene = scene_of(Product::ppi, Moment::hca);
    EXPECT_TRUE(validate(scene));
    EXPECT_EQ(legend_of(scene).table, nullptr);
    EXPECT_THAT(legend_texts(scene),
                ::testing::ElementsAre("biological", "ground clutter", "ice crystals", "dry snow",
                                       "wet snow", "rain", "heavy rain", "big drops", "graupel",
                                       "hail", "no echo", "range folded", "ambiguous", "not seen"));
}

TEST(ProductTitle, OfRotationSaysTheLayer) {
    Scene scene = scene_of(Product::rotation, Moment::azsh);
    EXPECT_EQ(product_title(scene), "Rotation, largest azimuthal shear 0 to 2 km above the radar");
    scene.product = Product::rotation_aloft;
    scene.units.height = Unit::kft;
    EXPECT_EQ(product_title(scene),
              "Rotation aloft, largest azimuthal shear 9.84 to 19.7 kft above the radar");
}

}  // namespace
}  // namespace stormcellar::render
