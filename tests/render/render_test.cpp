#include "stormcellar/render/render.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/frame/frame_cache.h"
#include "render/image/shades.h"
#include "render/map/map_layer.h"
#include "stormcellar/render/color_table.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;

Scene plain(Product product, int size) {
    Scene scene;
    scene.product = product;
    scene.width = scene.height = size;
    scene.labels = false;
    return scene;
}

// Returns the pixel in the middle of a cell. The picture has 520 pixels for 104 cells: 100 of the
// grid, and a margin of two on each side.
Rgba8 map_pixel(const Image& image, int ix, int iy) {
    return image.at(10 + 5 * ix + 2, 520 - 11 - 5 * iy - 2);
}

TEST(Composite, ShowsEachColumnsStateWhereItIs) {
    const grid::GridSpec spec = small_spec(100, 20);
    const auto grid = make_grid_of(spec, [](int ix, int iy, int iz) -> Cell {
        if (ix >= 80) return {CellStatus::not_seen, 0};
        if (ix == 10 && iy == 90) return iz == 7 ? valued(52) : valued(12);
        if (ix == 60 && iy == 20 && iz == 3) return {CellStatus::range_folded, 0};
        if (ix == 30 && iy == 20 && iz == 3) return valued(4);
        return {CellStatus::no_echo, 0};
    });
    const auto bricks = bricks_of(grid);
    const auto image =
        render_frame(bricks.view(), facts_of(grid), plain(Product::composite, 520), 2);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(map_pixel(*image, 10, 90), (Rgba8{0xFD, 0, 0, 255})) << "north-west is top left";
    EXPECT_EQ(map_pixel(*image, 60, 20), nws_reflectivity().range_folded);
    EXPECT_EQ(map_pixel(*image, 30, 20), shades::dark.land.seen) << "the value is below the table";
    EXPECT_EQ(map_pixel(*image, 50, 50), shades::dark.land.seen);
    EXPECT_EQ(image->at(1, 1), shades::dark.page);
    // Ground that was not seen is hatched: it has two colors, and neither is the color of clear
    // air.
    int lines = 0;
    int between = 0;
    for (int ix = 81; ix < 99; ++ix) {
        for (int iy = 5; iy < 95; ++iy) {
            const Rgba8 pixel = map_pixel(*image, ix, iy);
            EXPECT_NE(pixel, shades::dark.land.seen);
            lines += pixel != shades::dark.land.not_seen ? 1 : 0;
            between += pixel == shades::dark.land.not_seen ? 1 : 0;
        }
    }
    EXPECT_GT(lines, 100);
    EXPECT_GT(between, 100);
}

// Draws the same cells twice, with no echo in place of ambiguous. The pictures may differ only in
// the ambiguous columns, and there by thin lines in the color of range folding.
TEST(AmbiguousCells, AreHatchedInTheColorOfRangeFolding) {
    const auto frame = [](Product product, CellStatus status) {
        const auto grid = make_grid_of(small_spec(100, 4), [&](int ix, int iy, int) -> Cell {
            if (ix >= 20 && ix < 40) return {status, 0};
            if (ix >= 60 && ix < 80) return {CellStatus::range_folded, 0};
            return iy < 50 ? Cell{CellStatus::no_echo, 0} : valued(25);
        });
        FrameFacts facts = facts_of(grid);
        facts.moment = level2::Moment::veld;
        Scene scene = plain(product, 520);
        scene.moment = level2::Moment::veld;
        scene.cappi_height_m = 1200;
        const auto bricks =
            grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::veld));
        return render_frame(bricks.view(), facts, scene, 2).value();
    };
    for (const Product product : {Product::cappi, Product::composite}) {
        const Image plain_ground = frame(product, CellStatus::no_echo);
        const Image image = frame(product, CellStatus::ambiguous);
        const Rgba8 folded = default_color_table(level2::Moment::veld).range_folded;
        int lines = 0, between = 0;
        for (int y = 0; y < 520; ++y) {
            for (int x = 0; x < 520; ++x) {
                const bool is_ambiguous = x >= 110 && x < 210 && y >= 10 && y < 510;
                const Rgba8 ground = plain_ground.at(x, y);
                // Lines of the map are over the cells.
                if (is_ambiguous && ground != shades::dark.land.seen) continue;
                ASSERT_EQ(image.at(x, y), is_ambiguous ? hatched(ground, folded, x, y, 1) : ground)
                    << x << "," << y;
                lines += is_ambiguous && image.at(x, y) == folded ? 1 : 0;
                between += is_ambiguous && image.at(x, y) == ground ? 1 : 0;
            }
        }
        EXPECT_GT(lines, 4000);
        EXPECT_GT(between, 30000);
    }
}

TEST(VolumeFrame, TheGroundTellsHowItWasSeen) {
    const grid::GridSpec spec = small_spec(100, 20);
    const auto grid = make_grid_of(spec, [&](int ix, int, int iz) -> Cell {
        if (ix < 30) return {CellStatus::not_seen, 0};
        const bool aloft = spec.levels_m[static_cast<std::size_t>(iz)] >= 3000;
        return {ix < 60 && !aloft ? CellStatus::not_seen : CellStatus::no_echo, 0};
    });
    Scene scene = plain(Product::volume, 520);
    scene.camera.tilt_deg = 0;
    const auto bricks = bricks_of(grid);
    const auto image = render_frame(bricks.view(), facts_of(grid), scene, 2);
    ASSERT_TRUE(image);
    EXPECT_EQ(map_pixel(*image, 45, 50), shades::dark.land.seen_aloft);
    EXPECT_EQ(map_pixel(*image, 80, 50), shades::dark.land.seen);
    EXPECT_NE(map_pixel(*image, 10, 50), shades::dark.land.seen);
    EXPECT_NE(map_pixel(*image, 10, 50), shades::dark.land.seen_aloft);
}

TEST(RenderFrame, TheSamePixelsForAnyNumberOfThreads) {
    const auto grid = storm_grid(small_spec(120, 32, 4000, 500));
    const auto bricks = bricks_of(grid);
    for (const Product product : {Product::volume, Product::composite}) {
        Scene scene;
        scene.product = product;
        const auto one = render_frame(bricks.view(), facts_of(grid), scene, 1);
        ASSERT_TRUE(one);
        EXPECT_EQ(one->width, 796);
        EXPECT_EQ(one->height, 532);
        for (const int threads : {2, 5}) {
            EXPECT_EQ(render_frame(bricks.view(), facts_of(grid), scene, threads)->rgba, one->rgba);
        }
    }
}

TEST(RenderFrame, WhatIsKeptChangesNoPixel) {
    const auto storm = storm_grid(small_spec(120, 32, 4000, 500));
    const auto bricks = bricks_of(storm);
    const auto other = bricks_of(make_grid_of(storm.spec, [](int ix, int iy, int iz) {
        return (ix + iy) % 50 < 9 && iz < 12 ? valued(20 + iz) : Cell{};
    }));
    FrameCache keeper;
    const auto expect_same = [&](const grid::BrickGrid& drawn, Product product, int slices) {
        Scene scene;
        scene.product = product;
        scene.slices = slices;
        const auto alone = render_frame(drawn.view(), facts_of(storm), scene, 2);
        const auto kept = render_frame(drawn.view(), facts_of(storm), scene, 2, &keeper);
        ASSERT_TRUE(alone && kept);
        EXPECT_EQ(alone->rgba, kept->rgba);
    };
    expect_same(bricks, Product::composite, 32);
    expect_same(bricks, Product::composite, 32);
    expect_same(bricks, Product::volume, 400);  // enough slices for the corner table
    expect_same(other, Product::volume, 400);
    expect_same(bricks, Product::volume, 400);
    expect_same(other, Product::volume, 16);
    EXPECT_EQ(keeper.map.times_made(), 2);
    EXPECT_EQ(keeper.transfer.times_made(), 2);
}

TEST(RenderFrame, EveryPixelIsOpaqueFromAnySide) {
    const auto grid = storm_grid(small_spec(60, 8, 8000, 2000));
    const auto bricks = bricks_of(grid);
    for (const Camera& camera : {Camera{180, 0, 1}, Camera{180, 90, 1}, Camera{0, 90, 20},
                                 Camera{45, 89.9, 1000}, Camera{300, 10, 0.01}}) {
        Scene scene;
        scene.camera = camera;
        scene.slices = 32;
        const auto image = render_frame(bricks.view(), facts_of(grid), scene, 2);
        ASSERT_TRUE(image) << image.error().message;
        for (std::size_t i = 3; i < image->rgba.size(); i += 4)
            ASSERT_EQ(image->rgba[i], 255);
    }
}

TEST(RenderFrame, AGridOfOneCellCanBeDrawn) {
    const auto grid = make_grid_of(small_spec(1, 1), [](int, int, int) { return valued(40); });
    const auto bricks = bricks_of(grid);
    for (const Product product : {Product::volume, Product::composite}) {
        EXPECT_TRUE(render_frame(bricks.view(), facts_of(grid), plain(product, 64), 1));
    }
}

TEST(RenderFrame, RefusesWhatItCannotDraw) {
    const auto grid = storm_grid(small_spec(20, 4));
    const auto bricks = bricks_of(grid);
    FrameFacts velocity = facts_of(grid);
    velocity.moment = level2::Moment::vel;
    const auto moment = render_frame(bricks.view(), velocity, Scene{}, 1);
    ASSERT_FALSE(moment);
    EXPECT_EQ(moment.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(moment.error().message, ::testing::HasSubstr("VEL"));

    Scene scene;
    scene.slices = 0;
    EXPECT_EQ(render_frame(bricks.view(), facts_of(grid), scene, 1).error().code,
              ErrorCode::bad_argument);
    EXPECT_EQ(render_frame(grid::BrickView{}, facts_of(grid), Scene{}, 1).error().code,
              ErrorCode::bad_argument);
}

// Draws every product of reflectivity and every moment with labels. The pictures must have the full
// size.
TEST(RenderFrame, DrawsEveryProductAndMoment) {
    const auto grid = storm_grid(small_spec(60, 16, 4000, 1000));
    const auto bricks = bricks_of(grid);
    for (const Product product :
         {Product::volume, Product::composite, Product::cappi, Product::section, Product::echo_top,
          Product::vil, Product::lowest_seen, Product::highest_seen}) {
        Scene scene;
        scene.product = product;
        scene.section = SectionLine{{34.5, -98}, {35.5, -96}};
        const auto one = render_frame(bricks.view(), facts_of(grid), scene, 1);
        ASSERT_TRUE(one) << product_name(product) << " " << one.error().message;
        EXPECT_EQ(one->width, 796);
        EXPECT_EQ(one->height, 532);
        EXPECT_EQ(render_frame(bricks.view(), facts_of(grid), scene, 3)->rgba, one->rgba);
    }
    for (const level2::Moment moment : level2::all_moments) {
        FrameFacts facts = facts_of(grid);
        facts.moment = moment;
        Scene scene;
        scene.moment = moment;
        for (const Product product : {Product::volume, Product::cappi}) {
            scene.product = product;
            // Classes have no mean, so they are only drawn sweep by sweep.
            EXPECT_EQ(render_frame(bricks.view(), facts, scene, 2).has_value(),
                      !level2::facts_of(moment).is_categorical);
        }
    }
}

TEST(RenderFrame, TakesTheScenesColors) {
    const auto grid = make_grid_of(small_spec(100, 4), [](int, int, int) { return valued(52); });
    const auto bricks = bricks_of(grid);
    Scene scene = plain(Product::cappi, 520);
    scene.cappi_height_m = 1500;
    const auto usual = render_frame(bricks.view(), facts_of(grid), scene, 1);
    ASSERT_TRUE(usual);
    EXPECT_EQ(map_pixel(*usual, 50, 50), (Rgba8{0xFD, 0, 0, 255}));
    scene.colors = find_color_table("safe-reflectivity").value();
    const auto safe = render_frame(bricks.view(), facts_of(grid), scene, 1);
    EXPECT_EQ(map_pixel(*safe, 50, 50), *color_of(*scene.colors, 52));
    scene.cappi_height_m = 9000;
    EXPECT_EQ(render_frame(bricks.view(), facts_of(grid), scene, 1).error().code,
              ErrorCode::bad_argument);
}

// A dotted place shows its color and the dots.
TEST(EchoTops, ThatMayBeHigherAreDotted) {
    const auto grid = make_grid_of(small_spec(100, 4), [](int ix, int, int iz) -> Cell {
        if (iz == 3) return {CellStatus::no_echo, 0};
        return ix < 50 && iz == 2 ? Cell{CellStatus::not_seen, 0} : valued(40);
    });
    const auto bricks = bricks_of(grid);
    const auto image =
        render_frame(bricks.view(), facts_of(grid), plain(Product::echo_top, 520), 1);
    ASSERT_TRUE(image);
    int dots = 0;
    for (int y = 20; y < 500; ++y) {
        for (int x = 20; x < 250; ++x)
            dots += image->at(x, y) == shades::dark.page ? 1 : 0;
        for (int x = 270; x < 500; ++x)
            ASSERT_EQ(image->at(x, y), *color_of(echo_top_colors(), 1.5F));
    }
    EXPECT_GT(dots, 5000);
    EXPECT_LT(dots, 30000);
}

// Codes are addressed with 31 bits, but a wide grid with few levels can have more codes.
TEST(RenderFrame, AVolumeTooLargeToAddressIsRefused) {
    grid::GridSpec spec = small_spec(grid::GridSpec::greatest_side, 4, 100);
    grid::BrickView view;
    view.spec = &spec;
    view.bricks_x = view.bricks_y = grid::GridSpec::greatest_side / grid::brick_edge;
    view.bricks_z = 1;
    Scene scene;
    const auto refused = check_frame(view, {}, scene);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
    scene.product = Product::composite;
    EXPECT_TRUE(check_frame(view, {}, scene)) << "a map may be wide";
}

}  // namespace
}  // namespace stormcellar::render
