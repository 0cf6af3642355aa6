// Tests the layers of rotation with the tornado of Moore of May 3, 1999.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "render/options/scene_options.h"
#include "render/products/flat_field.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "tests/render/real_volume.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

struct Strongest {
    double x_m = 0, y_m = 0;  // from the radar to the east and north
    float value = 0;          // 0.001/s
};

Strongest strongest_of(const FlatField& field, const grid::GridSpec& spec) {
    Strongest found;
    for (int iy = 0; iy < field.height; ++iy) {
        for (int ix = 0; ix < field.width; ++ix) {
            const std::size_t at = field.index(ix, iy);
            // Close to the radar, the mean wind across the beam looks like shear.
            const bool is_near = std::hypot(spec.x_m(ix), spec.y_m(iy)) < 5000;
            if (is_near || field.status[at] != grid::CellStatus::value) continue;
            if (field.values[at] > found.value)
                found = {spec.x_m(ix), spec.y_m(iy), field.values[at]};
        }
    }
    return found;
}

// The tornado is at 35.25 N 97.69 W in the lowest sweep.
TEST(RotationLayers, IsStrongestAtTheTornadoOfMoore) {
    STORMCELLAR_NEED_DATA();
    const RealVolume real = real_volume("volumes/KTLX19990503_235621.gz");
    const auto derived = retrieve::add_derived_moments(*real.volume, std::array{Moment::azsh});
    ASSERT_TRUE(derived) << derived.error().message;
    EXPECT_EQ(retrieve::dealiasing_in_notes(derived->notes), "anchored");
    const grid::SiteFrame radar(real.site.latitude_deg, real.site.longitude_deg);
    const grid::PolarPoint tornado = radar.to_polar({35.25, -97.69});
    const double east_m = tornado.arc_m * std::sin(tornado.azimuth_deg * degree);
    const double north_m = tornado.arc_m * std::cos(tornado.azimuth_deg * degree);
    for (const double spacing_m : {500.0, 1000.0}) {
        grid::GridSpec spec = grid::default_spec(real.site.latitude_deg, real.site.longitude_deg);
        spec.spacing_m = spacing_m;
        spec.nx = spec.ny = static_cast<int>(120e3 / spacing_m);
        grid::GridderOptions options;
        options.moment = Moment::azsh;
        const auto made = grid::make_grid(*real.volume, real.site,
                                          **grid::make_column_geometry(real.site, spec), options);
        ASSERT_TRUE(made) << made.error().message;
        const auto bricks = grid::BrickGrid::from(*made, grid::default_quantization(Moment::azsh));
        FrameFacts facts{"KTLX", Moment::azsh, made->time, {real.site}, false};
        Scene scene;
        scene.moment = Moment::azsh;
        scene.product = Product::rotation;
        const auto low = map_field(bricks.view(), facts, scene, {}, 1);
        ASSERT_TRUE(low) << low.error().message;
        const Strongest strongest = strongest_of(*low, spec);
        EXPECT_LT(std::hypot(strongest.x_m - east_m, strongest.y_m - north_m), 1500) << spacing_m;
        EXPECT_GT(strongest.value, 15) << spacing_m;
        scene.product = Product::rotation_aloft;
        const Strongest aloft =
            strongest_of(map_field(bricks.view(), facts, scene, {}, 1).value(), spec);
        EXPECT_LT(std::hypot(aloft.x_m - east_m, aloft.y_m - north_m), 10e3)
            << "the mesocyclone of the tornado";
    }
}

}  // namespace
}  // namespace stormcellar::render
