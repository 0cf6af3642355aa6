// Compares tiles of a real volume with the grid's cells, pixel by pixel. Tests refusals, too.
#include "web/doors/pictures/tiles.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/web/asked.h"
#include "tests/web/pictured_storm.h"
#include "tests/web/served_grids.h"

namespace stormcellar::web {
namespace {

class Tiles : public MapDoorTest<TilesDoor> {
  protected:
    render::Image tile(const std::string& place, const std::string& layer = "composite.REF") {
        const Answer answer = get("/tiles/KTLX/" + layer + "/latest/" + place);
        EXPECT_EQ(answer.status, 200u) << body_of(answer);
        EXPECT_EQ(header_of(answer, "Content-Type"), "image/png");
        return decoded_png(body_of(answer));
    }
};

// Returns the place of a pixel's center in the picture of the world, by the textbook formula.
grid::GeoPoint place_of_pixel(double x, double y, int zoom, int side) {
    const double world = side * std::exp2(zoom);
    const double north = std::numbers::pi * (1 - 2 * (y + 0.5) / world);
    return {std::atan(std::sinh(north)) * 180 / std::numbers::pi, (x + 0.5) / world * 360 - 180};
}

// Compares pixels with the cells at their places. The server interpolates places on a mesh, so a
// pixel may show the neighboring cell if its center is within a tenth of a pixel of a cell's edge.
void expect_pixels(const render::Image& image, const OpenGrid& grid, int zoom, int column, int row,
                   int least_shown = 1000) {
    const auto style = map_style({render::Product::composite, grid.moment}, {}, {});
    ASSERT_TRUE(style);
    int wrong = 0, shown = 0;
    for (int y = 0; y < image.height; y += 3) {
        for (int x = 0; x < image.width; x += 3) {
            const auto place =
                place_of_pixel(column * image.width + x, row * image.height + y, zoom, image.width);
            const render::Rgba8 color = composite_color_at(grid, style->scene, place);
            if (image.at(x, y) != color) ++wrong;
            if (color[3] != 0) ++shown;
        }
    }
    EXPECT_GT(shown, least_shown);
    EXPECT_LE(wrong, image.width * image.height / 9 / 100);
}

TEST_F(Tiles, EachPixelShowsTheCellAtItsPlace) {
    const auto reflectivity = storm_->grid(level2::Moment::ref);
    const auto velocity = storm_->grid(level2::Moment::vel);
    expect_pixels(tile("8/58/100.png"), *reflectivity, 8, 58, 100);
    expect_pixels(tile("10/235/404@2x.png"), *reflectivity, 10, 235, 404);
    expect_pixels(tile("8/58/101.png", "composite.VEL"), *velocity, 8, 58, 101);
}

// The small grid has bricks of only ambiguous cells, and ambiguous cells between other cells.
TEST(TilesOfDealiasedVelocity, ShowAmbiguousCellsHalfTransparent) {
    ServedGrids served;
    const grid::Grid grid = testing::ambiguous_grid();
    const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(grid.moment));
    ASSERT_TRUE(served.store().commit("KBGM", cache::describe(grid), bricks.view()));
    TilesDoor door(
        std::make_shared<MapPictures>(MapPicturesOptions{.grids = served.shared_grids()}));
    // The tile holds the eastern half of the grid, with two pixels for a column.
    const Answer answer = asked(door, "/tiles/KBGM/composite.VELD/latest/8/74/94.png");
    ASSERT_EQ(answer.status, 200u) << body_of(answer);
    const render::Image image = decoded_png(body_of(answer));
    const auto newest = served.grids().newest("KBGM", grid.moment);
    const auto open = served.grids().find("KBGM", grid.moment, *newest);
    ASSERT_TRUE(open);
    expect_pixels(image, **open, 8, 74, 94, 50);
    const auto style = map_style({render::Product::composite, grid.moment}, {}, {});
    render::Rgba8 half_transparent = render::colors_of(style->scene).range_folded;
    half_transparent[3] /= 2;
    int ambiguous = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            ambiguous += image.at(x, y) == half_transparent ? 1 : 0;
    EXPECT_GT(ambiguous, 200);

    // Seen from afar, four cells become one: a value if any of the four has a value, else
    // ambiguous.
    render::FlatField four(2, 2);
    four.put(0, grid::CellStatus::ambiguous, 0);
    four.put(1, grid::CellStatus::range_folded, 0);
    four.put(2, grid::CellStatus::no_echo, 0);
    const auto together = halved_field(four, style->scene, 1);
    EXPECT_EQ(together.status, std::vector{grid::CellStatus::ambiguous});
    four.put(3, grid::CellStatus::value, -7);
    EXPECT_EQ(halved_field(four, style->scene, 1).values, std::vector{-7.0F});
}

TEST_F(Tiles, FromAfarNoEchoIsLost) {
    // At zoom 4 a pixel covers four columns and more. The strongest echo must be there.
    const auto style = map_style({}, {}, {});
    const render::Image image = tile("4/3/6.png");
    const render::ColorTable& table = render::colors_of(style->scene);
    const render::Rgba8 strongest = *render::color_of(table, 65);
    int red = 0;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
            if (image.at(x, y)[3] == 255 && image.at(x, y)[0] >= strongest[0] - 40) ++red;
    EXPECT_GT(red, 0);
    int shown = 0;
    const render::Image world = tile("0/0/0.png");
    for (std::size_t i = 3; i < world.rgba.size(); i += 4)
        if (world.rgba[i] != 0) ++shown;
    EXPECT_GT(shown, 2) << "a grid of 4 degrees is about 3 by 3 pixels of the world";
    EXPECT_LT(shown, 25);
}

TEST_F(Tiles, OutsideOfTheGridAllIsClear) {
    const render::Image image = tile("8/10/10.png");
    EXPECT_EQ(image.width, 256);
    for (const std::uint8_t byte : image.rgba)
        ASSERT_EQ(byte, 0);
}

TEST_F(Tiles, EveryLayerOfTheIndexHasATile) {
    const auto index = nlohmann::json::parse(body_of(get("/tiles")));
    ASSERT_EQ(index["domains"].size(), 1u);
    std::vector<std::string> names;
    for (const auto& layer : index["domains"][0]["layers"])
        names.push_back(layer["layer"]);
    EXPECT_EQ(names,
              (std::vector<std::string>{"composite.REF", "composite.VEL", "cappi.REF", "cappi.VEL",
                                        "echotop", "vil", "vil-density", "maximum-height",
                                        "lowest-seen.REF", "lowest-seen.VEL", "highest-seen.REF",
                                        "highest-seen.VEL", "mesh", "posh", "shi"}));
    for (const std::string& name : names) {
        const render::Image image = tile("7/29/50.png", name);
        int shown = 0;
        for (std::size_t i = 3; i < image.rgba.size(); i += 4)
            if (image.rgba[i] != 0) ++shown;
        EXPECT_GT(shown, 20) << name;
    }
}

TEST_F(Tiles, TileJsonLeadsToTiles) {
    const auto json =
        nlohmann::json::parse(body_of(get(std::string("/tiles/KTLX/cappi.REF/") +
                                          PicturedStorm::time + "/tilejson.json?height-km=5")));
    EXPECT_EQ(json["tilejson"], "3.0.0");
    EXPECT_LT(json["bounds"][0], -99.7);
    EXPECT_GT(json["bounds"][2], -94.8);
    std::string url = json["tiles"][0];
    const std::string base = "http://localhost:8090";
    ASSERT_TRUE(url.starts_with(base)) << url;
    url = url.substr(base.size());
    for (const auto& [name, number] : {std::pair{"{z}", "8"}, {"{x}", "58"}, {"{y}", "100"}})
        url.replace(url.find(name), 3, number);
    const Answer high = get(url);
    EXPECT_EQ(high.status, 200u);
    EXPECT_NE(body_of(high), body_of(get("/tiles/KTLX/cappi/latest/8/58/100.png")));
}

TEST_F(Tiles, OptionsChangeThePictureAndItsTag) {
    const std::string path = "/tiles/KTLX/composite/latest/8/58/100.png";
    const Answer usual = get(path);
    const Answer classes = get(path + "?colors=nws");
    const Answer smooth = get(path + "?smooth=cubic");
    EXPECT_NE(body_of(usual), body_of(classes));
    EXPECT_NE(body_of(usual), body_of(smooth));
    EXPECT_NE(header_of(usual, "ETag"), header_of(classes, "ETag"));
    EXPECT_NE(header_of(usual, "ETag"), header_of(smooth, "ETag"));
}

TEST_F(Tiles, AreKeptAndHaveTags) {
    const std::string path = "/tiles/KTLX/composite/latest/8/58/100.png";
    EXPECT_FALSE(door_->answer_at_once(request_for(path))) << "nothing is kept yet";
    const std::string etag = header_of(get(path), "ETag");
    ASSERT_FALSE(etag.empty());
    const auto kept = door_->answer_at_once(request_for(path));
    ASSERT_TRUE(kept);
    EXPECT_EQ(header_of(*kept, "ETag"), etag);
    EXPECT_EQ(header_of(*kept, "Cache-Control"), "no-cache")
        << "\"latest\" soon means another grid";
    EXPECT_EQ(get(path, {{"If-None-Match", etag}}).status, 304u);
    const std::string named = std::string("/tiles/KTLX/composite/") + PicturedStorm::time;
    EXPECT_EQ(header_of(get(named + "/8/58/100.png"), "ETag"), etag)
        << "the tile has the same bytes";
    EXPECT_EQ(header_of(get(named + "/8/58/100.png"), "Cache-Control"), "max-age=300");
    EXPECT_EQ(get(named + "/8/59/100.png", {{"If-None-Match", etag}}).status, 200u);
}

TEST_F(Tiles, RefusesWhatMakesNoSense) {
    for (const char* target : {"/tiles/KTLX/composite/latest/8/58/100.png?colour=red",
                               "/tiles/KTLX/composite/latest/8/58/100.png?height-km=3",
                               "/tiles/KTLX/composite/latest/8/58/100.png?colors=/etc/passwd.pal",
                               "/tiles/KTLX/composite/latest/8/58/100.png?moment=VEL",
                               "/tiles/KTLX/composite/latest/8/58/100.png?width=4000",
                               "/tiles/KTLX/cappi/latest/8/58/100.png?height-km=nan",
                               "/tiles/KTLX/cappi/latest/8/58/100.png?height-km=59",
                               "/tiles/KTLX/cappi/latest/8/58/100.png?height-km=3&height-km=4",
                               "/tiles/KTLX/composite/soon/8/58/100.png"})
        EXPECT_EQ(get(target).status, 400u) << target;
    for (const char* target :
         {"/tiles/KTLX/composite/latest/8/256/100.png", "/tiles/KTLX/composite/latest/8/-1/100.png",
          "/tiles/KTLX/composite/latest/23/0/0.png", "/tiles/KTLX/composite/latest/8/58/100.jpg",
          "/tiles/KTLX/composite/latest/08/58/100.png", "/tiles/KTLX/composite/latest/8/58/x.png",
          "/tiles/KTLX/composite/latest/99999999999/0/0.png",
          "/tiles/KTLX/composite/latest/8/58/100@3x.png", "/tiles/KTLX/volume/latest/8/58/100.png",
          "/tiles/KTLX/ppi/latest/8/58/100.png", "/tiles/KTLX/vil.VEL/latest/8/58/100.png",
          "/tiles/KTLX/composite.XYZ/latest/8/58/100.png", "/tiles/KXXX/composite/latest/8/1/1.png",
          "/tiles/KTLX/composite/2024-01-01T00:00:00Z/8/58/100.png",
          "/tiles/KTLX/composite.ZDR/latest/8/58/100.png", "/tiles/KTLX", "/tiles/KTLX/composite"})
        EXPECT_EQ(get(target).status, 404u) << target;
}

TEST(MapLayers, HaveNames) {
    EXPECT_EQ(map_product_named("composite")->name(), "composite.REF");
    EXPECT_EQ(map_product_named("cappi.ZDR")->name(), "cappi.ZDR");
    EXPECT_EQ(map_product_named("vil.REF")->name(), "vil");
    EXPECT_FALSE(map_product_named("vil.VEL"));
    EXPECT_FALSE(map_product_named("section"));
    EXPECT_FALSE(map_product_named(""));
}

TEST(TilesOfTheEarth, AreTwiceAsManyAtEachZoom) {
    const auto world = window_of(*tile_place_of("0", "0", "0.png"));
    EXPECT_NEAR(world.west, -20037508.34, 0.01);
    EXPECT_NEAR(world.north, 20037508.34, 0.01);
    EXPECT_NEAR(world.east, 20037508.34, 0.01);
    const auto last = window_of(*tile_place_of("3", "7", "7.png"));
    EXPECT_NEAR(last.east, 20037508.34, 0.01);
    EXPECT_NEAR(last.south, -20037508.34, 0.01);
}

}  // namespace
}  // namespace stormcellar::web
