#include "render/volume/haze.h"

#include <cmath>

#include <gtest/gtest.h>

#include "render/image/shades.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

constexpr Rgba8 ground = {20, 20, 20, 255};

// Returns the share of haze in a gray picture.
double haze_at(const Image& picture, int x, int y) {
    return (picture.at(x, y)[0] - ground[0]) /
           static_cast<double>(shades::dark.haze[0] - ground[0]);
}

Image hazy(const grid::BrickView& view, const ViewGeometry& geometry, int threads) {
    Image picture(geometry.width(), geometry.height(), ground);
    draw_haze(view, geometry, shades::dark.haze, threads, picture);
    return picture;
}

// The camera looks straight down, and nothing was seen in the western half. In that half, the path
// of a ray through unseen air is the height of the box.
TEST(Haze, IsAsThickAsTheWayThroughAirThatWasNotSeen) {
    const grid::GridSpec spec = small_spec(48, 16);
    const auto bricks = bricks_of(make_grid_of(spec, [](int ix, int, int iz) {
        if (ix >= 24) return iz == 3 ? valued(40) : Cell{};
        return Cell{grid::CellStatus::not_seen, 0};
    }));
    const ViewGeometry geometry(spec, {180, 0, 0.8}, 2, 200, 200);
    const Image picture = hazy(bricks.view(), geometry, 1);
    const double way_m = (geometry.top_m() - geometry.bottom_m()) * 2;
    const double depth_m = geometry.far_m() - geometry.near_m();
    const double expected = most_haze * (1 - std::exp(-way_m / (0.2 * depth_m)));
    const Pixel west = geometry.project(-12e3, 0, 4000);
    const Pixel east = geometry.project(12e3, 0, 4000);
    EXPECT_NEAR(haze_at(picture, static_cast<int>(west.x), static_cast<int>(west.y)), expected,
                0.01);
    EXPECT_EQ(picture.at(static_cast<int>(east.x), static_cast<int>(east.y)), ground);
    EXPECT_EQ(picture.at(1, 1), ground);  // beside the box
    EXPECT_EQ(hazy(bricks.view(), geometry, 3).rgba, picture.rgba);
}

// If half of the levels of each coarse cell were not seen, the path through unseen air is half as
// long, also in bricks without values. Bricks of seen air alone give no haze.
TEST(Haze, CountsTheShareOfEachCell) {
    const grid::GridSpec spec = small_spec(48, 16);
    const auto half = bricks_of(make_grid_of(spec, [](int, int, int iz) {
        return iz % 2 == 0 ? Cell{grid::CellStatus::not_seen, 0} : valued(30);
    }));
    const auto no_values = bricks_of(make_grid_of(spec, [](int, int, int iz) {
        return iz % 2 == 0 ? Cell{grid::CellStatus::not_seen, 0} : Cell{};
    }));
    const auto none = bricks_of(make_grid_of(spec, [](int, int, int) { return Cell{}; }));
    const ViewGeometry geometry(spec, {180, 0, 1}, 2, 200, 200);
    const double way_m = (geometry.top_m() - geometry.bottom_m());
    const double depth_m = geometry.far_m() - geometry.near_m();
    const double expected = most_haze * (1 - std::exp(-way_m / (0.2 * depth_m)));
    EXPECT_NEAR(haze_at(hazy(half.view(), geometry, 2), 100, 100), expected, 0.01);
    EXPECT_NEAR(haze_at(hazy(no_values.view(), geometry, 2), 100, 100), expected, 0.01);
    EXPECT_EQ(hazy(none.view(), geometry, 2).at(100, 100), ground);
}

}  // namespace
}  // namespace stormcellar::render
