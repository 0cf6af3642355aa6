// Tests how fast each method converges with more slices, and what interpolation between rays costs.
#include <cmath>

#include <gtest/gtest.h>

#include "render/volume/slicer.h"
#include "tests/render/against_reference.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

// Returns a table without jumps: colors blend, and extinction rises linearly.
ColorTable smooth_table() {
    ColorTable table;
    table.stops = {{0, {20, 40, 250, 255}, {250, 60, 20, 255}},
                   {60, {250, 60, 20, 255}, {250, 60, 20, 255}}};
    table.end = 70;
    table.extinction = {{0, 0}, {60, 0.5}};
    return table;
}

// Returns a ball whose value falls smoothly from its middle. The ball is so high that rays from
// above begin inside it, and the cells are so fine that its curvature counts.
grid::BrickGrid ball(const grid::GridSpec& spec) {
    return grid::BrickGrid::from(
        make_grid_of(spec,
                     [&](int ix, int iy, int iz) {
                         const double x = spec.x_m(ix) / 12e3;
                         const double y = spec.y_m(iy) / 12e3;
                         const double z =
                             (spec.levels_m[static_cast<std::size_t>(iz)] - 15e3) / 7e3;
                         return valued(66 * std::exp(-x * x - y * y - z * z) - 6);
                     }),
        {2, -32, 0.01F});
}

double error_of(const grid::BrickView& bricks, const ViewGeometry& view, const ColorTable& table,
                const VolumeOptions& options) {
    const Layer layer = sliced(bricks, view, options, 2, table);
    return against_reference({bricks, table, view, options.opacity}, layer, 8192, 2, 7).rms;
}

// Returns the order of convergence, from the errors with 8 and with 32 slices.
double order_of(Integration integration) {
    const grid::GridSpec spec = small_spec(96, 64, 500, 250);
    const auto bricks = ball(spec);
    const ViewGeometry view(spec, {200, 40, 1}, 2, 120, 90);
    const auto error = [&](int slices) {
        return error_of(bricks.view(), view, smooth_table(), {slices, integration, 0.1});
    };
    return 0.5 * std::log2(error(8) / error(32));
}

TEST(Convergence, RiemannIsOfFirstOrder) {
    EXPECT_NEAR(order_of(Integration::riemann), 1, 0.3);
}

TEST(Convergence, PreIntegrationInOrderIsOfSecondOrder) {
    EXPECT_NEAR(order_of(Integration::second_order), 2, 0.4);
}

TEST(Convergence, WithoutAttenuationInsideTheStepItIsWorseInOpaqueScenes) {
    const grid::GridSpec spec = small_spec(96, 64, 500, 250);
    const auto bricks = ball(spec);
    const ViewGeometry view(spec, {200, 40, 1}, 2, 120, 90);
    const auto error = [&](Integration integration, int slices) {
        return error_of(bricks.view(), view, smooth_table(), {slices, integration, 8});
    };
    const double mean = error(Integration::first_order, 16);
    EXPECT_GT(mean, 1.3 * error(Integration::second_order, 16));
    EXPECT_LT(mean, 0.6 * error(Integration::riemann, 16));
}

TEST(Smooth, InterpolationBetweenRaysStaysNearItsTolerance) {
    const grid::GridSpec spec = small_spec(60, 20, 8000, 800);
    const auto bricks = bricks_of(storm_grid(spec));
    const ViewGeometry view(spec, {180, 30, 1}, 8, 500, 400);
    const auto draw = [&](double tolerance) {
        return sliced(bricks.view(), view, {256, Integration::second_order, 1, tolerance});
    };
    const Layer all = draw(0);
    double previous = 0;
    for (const double tolerance : {0.002, 0.01, 0.05}) {
        const Layer some = draw(tolerance);
        std::size_t far_off = 0;
        double sum = 0;
        for (std::size_t i = 0; i < all.rgba.size(); ++i) {
            const double off = std::abs(static_cast<double>(all.rgba[i] - some.rgba[i]));
            sum += off;
            if (off > 4 * tolerance) ++far_off;
        }
        EXPECT_LT(static_cast<double>(far_off), 0.01 * static_cast<double>(all.rgba.size()));
        EXPECT_GT(sum, previous) << "this tolerance interpolates more pixels";
        previous = sum;
    }
}

TEST(Smooth, ASingleCellIsNotLost) {
    const grid::GridSpec spec = small_spec(40, 12);
    for (const int at : {17, 18, 19, 20}) {
        const auto bricks = bricks_of(make_grid_of(spec, [&](int ix, int iy, int iz) {
            return ix == at && iy == 22 && iz == 6 ? valued(60) : Cell{};
        }));
        const ViewGeometry view(spec, {180, 20, 1}, 3, 400, 300);
        const auto sum_of = [&](double tolerance) {
            const Layer layer =
                sliced(bricks.view(), view, {128, Integration::second_order, 1, tolerance}, 1);
            double sum = 0;
            for (const float channel : layer.rgba)
                sum += static_cast<double>(channel);
            return sum;
        };
        EXPECT_NEAR(sum_of(0.02) / sum_of(0), 1, 0.1) << at;
    }
}

}  // namespace
}  // namespace stormcellar::render
