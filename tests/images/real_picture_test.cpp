// Compares pictures of real volumes, from the file to the pixels, with stored references.
#include <string>

#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/render/render.h"
#include "tests/images/reference_check.h"
#include "tests/testing/data.h"

namespace stormcellar::images {
namespace {

void expect_reference(const std::string& file, const render::Scene& scene,
                      const std::string& name) {
    auto decoded = level2::decode_file(testing::real_file("volumes") / file);
    ASSERT_TRUE(decoded) << decoded.error().message;
    const level2::Volume& volume = decoded->volume;
    const auto antenna = level2::antenna_position(volume);
    ASSERT_TRUE(antenna);
    const grid::SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    const auto spec = grid::default_spec(site.latitude_deg, site.longitude_deg);
    const auto geometry = grid::make_column_geometry(site, spec);
    ASSERT_TRUE(geometry);
    const auto grid = grid::make_grid(volume, site, **geometry, {});
    ASSERT_TRUE(grid) << grid.error().message;
    const auto bricks =
        grid::BrickGrid::from(*grid, grid::default_quantization(level2::Moment::ref));
    render::FrameFacts facts;
    facts.domain = volume.station;
    facts.time = parse_compact(file.substr(4, 8) + "_" + file.substr(13, 6)).value();
    facts.sites = {site};
    const auto picture = render::render_frame(bricks.view(), facts, scene, 2);
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_TRUE(matches_reference(*picture, name));
}

TEST(RealPicture, TheSupercellsOfOklahomaFromAbove) {
    STORMCELLAR_NEED_DATA();
    render::Scene scene;
    scene.product = render::Product::composite;
    scene.width = 400;
    scene.height = 300;
    expect_reference("KTLX19990503_235621.gz", scene, "real-supercells");
}

TEST(RealPicture, KatrinaIn3D) {
    STORMCELLAR_NEED_DATA();
    render::Scene scene;
    scene.camera = {200, 58, 1.3, 35, std::nullopt};
    scene.width = 320;
    scene.height = 240;
    scene.labels = false;
    expect_reference("KLIX20050828_180149.gz", scene, "real-hurricane");
}

}  // namespace
}  // namespace stormcellar::images
