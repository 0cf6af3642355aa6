// Tests that maps and pictures of hail of a mosaic show the hail of its radars.
#include "web/data/pictures/shown_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/options/scene_options.h"
#include "render/still/map_raster.h"
#include "tests/pipeline/hailed_frame.h"
#include "web/data/pictures/map_pictures.h"

namespace stormcellar::web {
namespace {

TEST(ShownGrid, HasTheHailOfTheRadarsOrSaysThatItHasNot) {
    const pipeline::HailedFrame frame;
    const auto grids = *Grids::open({.cache = frame.store.directory()});
    const auto grid = *grids->find("north", level2::Moment::ref, frame.instant);
    const auto style = *map_style({render::Product::mesh, level2::Moment::ref}, {}, {});
    const auto merged = *pipeline::hail_of_frame(frame.store, {.domain = "north", .levels = {}},
                                                 frame.description, grid->file.view());
    const auto field_of = [&](const grid::BrickView& view) {
        const auto facts = render::frame_facts_of("north", frame.description, "UTC");
        return *render::still_field({view, facts, style.scene}, 1);
    };
    const auto mesh = field_of(merged.bricks.view()).values;
    const auto of_mean = field_of(grid->file.view()).values;
    ASSERT_NE(mesh, of_mean);
    MapPictures pictures({.grids = grids});
    EXPECT_EQ((*pictures.map_of(*grid, style.scene))->levels.front().values, mesh);

    frame.forget_one();
    MapPictures later({.grids = grids});
    EXPECT_EQ((*later.map_of(*grid, style.scene))->levels.front().values, of_mean);
    const auto shown = shown_grid(frame.store.directory(), *grid, style.scene, 1);
    ASSERT_TRUE(shown);
    EXPECT_THAT(shown->description().provenance.notes,
                ::testing::Contains(::testing::HasSubstr("which may be too small: the grid of ")));
}

}  // namespace
}  // namespace stormcellar::web
