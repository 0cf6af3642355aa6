#include "stormcellar/render/light.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "render/volume/light_volume.h"
#include "render/volume/slicer.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

TEST(Light, IsNamedByItsKinds) {
    Light light;
    EXPECT_EQ(light_names(light), "none");
    ASSERT_TRUE(set_light("shadow,gradient", light));
    EXPECT_TRUE(light.gradient && light.shadow && !light.scattering);
    EXPECT_EQ(light_names(light), "gradient,shadow");
    EXPECT_EQ(set_light("shadow,gloom", light).error().message,
              "there is no light 'gloom'; the known kinds are none, gradient, shadow, scattering");
    EXPECT_EQ(set_light("shadow,gradent", light).error().message,
              "there is no light 'gradent'; did you mean 'gradient'?");
    EXPECT_FALSE(set_light("", light));
    for (const char* mixed : {"none,gradient", "shadow,none", "none,none"}) {
        const Status status = set_light(mixed, light);
        ASSERT_FALSE(status) << mixed;
        EXPECT_EQ(
            status.error().message,
            fmt::format("none cannot be combined with other kinds of light, as in '{}'", mixed));
    }
    EXPECT_TRUE(light.shadow) << "an error changes nothing";
    ASSERT_TRUE(set_light("none", light));
    EXPECT_FALSE(light.any());
}

Light lit_by(const std::string& names, double azimuth_deg = 225, double elevation_deg = 40) {
    Light light;
    EXPECT_TRUE(set_light(names, light));
    light.sun_azimuth_deg = azimuth_deg;
    light.sun_elevation_deg = elevation_deg;
    return light;
}

Layer draw(const grid::BrickView& view, const ViewGeometry& geometry, const Light& light,
           int threads = 2, double opacity = 1) {
    VolumeOptions options{128, Integration::second_order, opacity};
    options.light = light;
    return sliced(view, geometry, options, threads);
}

// tests/render/lit_layer_test.cpp tests hues and lightness on real volumes.
TEST(Light, ChangesNoOpacityAndMakesSomeLighterAndSomeDarker) {
    const grid::GridSpec spec = small_spec(60, 16, 4000, 500);
    const auto bricks = bricks_of(storm_grid(spec));
    const ViewGeometry view(spec, {180, 50, 1}, 5, 160, 120);
    const Layer plain = draw(bricks.view(), view, {});
    for (const char* names : {"gradient", "shadow", "scattering", "gradient,shadow,scattering"}) {
        const Layer lit = draw(bricks.view(), view, lit_by(names));
        double darker = 0, lighter = 0;
        for (std::size_t i = 0; i < lit.rgba.size(); i += 4) {
            ASSERT_EQ(lit.rgba[i + 3], plain.rgba[i + 3]) << names;
            const float change = lit.rgba[i + 1] - plain.rgba[i + 1];  // green
            (change < 0 ? darker : lighter) += static_cast<double>(std::abs(change));
        }
        EXPECT_GT(darker, 10) << names;
        EXPECT_GT(lighter, 5) << names;
    }
}

// Returns the mean of the green channel, which light raises in red echo.
double mean_green(const Layer& layer, int from_x, int to_x) {
    double sum = 0, alpha = 0;
    for (int y = 0; y < layer.height; ++y) {
        for (int x = from_x; x < to_x; ++x) {
            const auto at = static_cast<std::size_t>(y * layer.width + x) * 4;
            sum += static_cast<double>(layer.rgba[at + 1]);
            alpha += static_cast<double>(layer.rgba[at + 3]);
        }
    }
    return sum / alpha;
}

// Draws an opaque dome under a low sun. The side toward the sun must be lighter than the other
// side.
TEST(Light, TheSideTurnedToTheSunIsLighter) {
    const grid::GridSpec spec = small_spec(64, 32);
    const auto bricks = bricks_of(make_grid_of(spec, [&](int ix, int iy, int iz) -> Cell {
        const double x = spec.x_m(ix) / 12e3, y = spec.y_m(iy) / 12e3;
        const double z = (spec.levels_m[static_cast<std::size_t>(iz)] - 8e3) / 6e3;
        const double r = std::sqrt(x * x + y * y + z * z);
        return r < 1.2 ? valued(50 + 4.9 * (1.2 - r) / 1.2) : Cell{};
    }));
    const ViewGeometry view(spec, {180, 0, 1}, 1, 200, 200);
    for (const char* names : {"gradient", "shadow", "scattering"}) {
        const Layer west = draw(bricks.view(), view, lit_by(names, 270, 25), 2, 30);
        const Layer east = draw(bricks.view(), view, lit_by(names, 90, 25), 2, 30);
        EXPECT_GT(mean_green(west, 0, 100), mean_green(west, 100, 200) + 0.02) << names;
        EXPECT_GT(mean_green(east, 100, 200), mean_green(east, 0, 100) + 0.02) << names;
        EXPECT_NEAR(mean_green(west, 0, 100), mean_green(east, 100, 200), 0.03) << names;
    }
}

LightVolume volume_of(const grid::BrickGrid& bricks, const grid::GridSpec& spec, const Light& light,
                      double opacity, int threads = 1) {
    const ViewGeometry geometry(spec, {180, 30, 1}, 1, 100, 100);
    const TransferFunction transfer(nws_reflectivity(), bricks.view().quantization, opacity, 1000,
                                    Integration::second_order);
    return {bricks.view(), transfer, 1000, geometry, light, threads};
}

// With the sun at the zenith, a coarse cell in a homogeneous slab gets the light exp(-k d), where d
// is the distance from the top of the slab to the top of the cell.
TEST(LightVolume, UnderASlabIsTheClosedForm) {
    const grid::GridSpec spec = small_spec(64, 32);  // 500 m apart: a coarse cell is 1 km high
    constexpr double dbz = 41.875 + 0.5 * 0.3125;
    const auto bricks = grid::BrickGrid::from(
        make_grid_of(spec, [](int, int, int iz) { return iz >= 16 ? valued(dbz) : Cell{}; }),
        {1, dbz, 1});
    const LightVolume light = volume_of(bricks, spec, lit_by("shadow", 0, 90), 0.5);
    const double k = extinction_per_m(nws_reflectivity(), dbz, 0.5);
    for (const int z : {15, 12, 8}) {
        EXPECT_NEAR(light.sun_at(8, 8, z), std::exp(-k * 1000 * (15 - z)), 1e-4);
    }
    for (const int z : {7, 3, 0})
        EXPECT_NEAR(light.sun_at(8, 8, z), std::exp(-k * 8000), 1e-4)
            << "the cell is below the slab";
}

// The shadow of a tower points away from the sun, and is longer if the sun is lower.
TEST(LightVolume, ATowersShadowFallsAwayFromTheSun) {
    const grid::GridSpec spec = small_spec(128, 32);
    const auto bricks = bricks_of(make_grid_of(spec, [](int ix, int iy, int) -> Cell {
        return ix >= 60 && ix < 68 && iy >= 60 && iy < 68 ? valued(60) : Cell{};
    }));
    const LightVolume light = volume_of(bricks, spec, lit_by("shadow", 270, 45), 1);
    // The tower is 16 km high, so its shadow on the ground reaches 16 km to the east.
    EXPECT_LT(light.sun_at(19, 16, 0), 0.3F) << "10 km to the east";
    EXPECT_GT(light.sun_at(25, 16, 0), 0.9F) << "36 km to the east";
    EXPECT_GT(light.sun_at(12, 16, 0), 0.99F) << "the cell is to the west of the tower";
    EXPECT_GT(light.sun_at(19, 22, 0), 0.9F) << "the cell is beside the shadow";
    EXPECT_GT(light.sun_at(19, 16, 14), 0.9F) << "the cell is above the shadow";
}

TEST(LightVolume, IsTheSameForAnyNumberOfThreads) {
    const grid::GridSpec spec = small_spec(60, 20, 4000, 800);
    const auto bricks = bricks_of(storm_grid(spec));
    const ViewGeometry view(spec, {163, 48, 1.3}, 8, 133, 102);
    const Light all = lit_by("gradient,shadow,scattering");
    const Layer one = draw(bricks.view(), view, all, 1);
    EXPECT_EQ(draw(bricks.view(), view, all, 3).rgba, one.rgba);
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        const Layer layer = draw(bricks.view(), view, all, 2);
        hwy::SetSupportedTargetsForTest(0);
        EXPECT_EQ(layer.rgba, one.rgba) << hwy::TargetName(target);
    }
}

}  // namespace
}  // namespace stormcellar::render
