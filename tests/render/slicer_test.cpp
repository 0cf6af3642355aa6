#include "render/volume/slicer.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "tests/render/against_reference.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;

Layer slice(const grid::BrickView& view, const ViewGeometry& geometry, int slices, double opacity,
            int threads, Integration integration = Integration::second_order) {
    return sliced(view, geometry, {slices, integration, opacity}, threads);
}

// In closed form, a slab of one value and height H, seen at tilt t with exaggeration e, has the
// opacity 1 - exp(-k H e / cos t) wherever a ray crosses it from top to bottom. The slab has the
// value in the middle of a bin of the transfer function, because every value of a bin looks like
// the middle.
TEST(Slicer, OpacityOfAHomogeneousSlabIsTheClosedForm) {
    const grid::GridSpec spec = small_spec(200, 16);
    constexpr double dbz = 41.875 + 0.5 * 0.3125;
    const grid::Quantization exact{1, dbz, 1};
    const auto bricks =
        grid::BrickGrid::from(make_grid_of(spec, [](int, int, int) { return valued(dbz); }), exact);
    for (const double tilt : {0.0, 20.0, 40.0}) {
        for (const int slices : {8, 64, 1000}) {
            for (const double opacity : {0.03, 0.4}) {
                const ViewGeometry geometry(spec, {200, tilt, 1}, 2, 90, 70);
                const Layer layer = slice(bricks.view(), geometry, slices, opacity, 1);
                const double path_m = 16 * 500 * 2 / std::cos(tilt / 57.29577951308232);
                const double alpha =
                    1 - std::exp(-extinction_per_m(nws_reflectivity(), dbz, opacity) * path_m);
                const auto color = pixel_of(layer, 45, 35);
                EXPECT_NEAR(color[3], alpha, 2e-5) << tilt << " " << slices;
                EXPECT_NEAR(color[0] / color[3], 0xE5 / 255.0, 1e-4);
                EXPECT_NEAR(color[1] / color[3], 0xBC / 255.0, 1e-4);
                EXPECT_NEAR(color[2], 0, 1e-6);
            }
        }
    }
}

// Tests, from several directions, where one cell appears in the picture, so that no picture can be
// mirrored or turned.
void expect_cells_where_geometry_puts_them(const grid::GridSpec& spec) {
    struct Place {
        int ix, iy, iz;
    };
    const Place places[] = {{5, 33, 2}, {30, 4, 10}, {39, 39, 6}, {17, 20, 0}};
    for (const Place& place : places) {
        const auto bricks = bricks_of(make_grid_of(spec, [&](int ix, int iy, int iz) -> Cell {
            if (ix == place.ix && iy == place.iy && iz == place.iz) return valued(60);
            return {CellStatus::no_echo, 0};
        }));
        for (const Camera& camera : {Camera{180, 55, 1}, Camera{180, 0, 1}, Camera{90, 60, 1},
                                     Camera{0, 30, 1}, Camera{315, 80, 1}, Camera{37, 90, 1}}) {
            const ViewGeometry geometry(spec, camera, 3, 300, 260);
            const Layer layer = slice(bricks.view(), geometry, 400, 0.2, 1);
            double sum = 0;
            double x = 0;
            double y = 0;
            for (int py = 0; py < layer.height; ++py) {
                for (int px = 0; px < layer.width; ++px) {
                    const double a = pixel_of(layer, px, py)[3];
                    sum += a;
                    x += a * (px + 0.5);
                    y += a * (py + 0.5);
                }
            }
            ASSERT_GT(sum, 0) << camera.azimuth_deg;
            const Pixel expected =
                geometry.project(spec.x_m(place.ix), spec.y_m(place.iy),
                                 spec.levels_m[static_cast<std::size_t>(place.iz)]);
            // At the edge of the grid, half of the cell's reach is cut off, which moves the middle
            // of the echo.
            const double pixels_per_cell = std::max(1000.0, 1500.0) / geometry.metres_per_pixel();
            const bool at_edge = place.ix == 39 || place.iz == 0;
            EXPECT_NEAR(x / sum, expected.x, at_edge ? 0.4 * pixels_per_cell : 0.35);
            EXPECT_NEAR(y / sum, expected.y, at_edge ? 0.4 * pixels_per_cell : 0.35);
        }
    }
}

TEST(Slicer, ASingleCellLandsWhereGeometryPutsIt) {
    expect_cells_where_geometry_puts_them(small_spec(40, 12));
    expect_cells_where_geometry_puts_them(small_degrees_spec(40, 12));
}

TEST(Slicer, AgreesWithTheReferenceMarcherOnAStorm) {
    grid::GridSpec spec = small_spec(120, 20, 4000, 800);
    for (const bool even_levels : {true, false}) {
        if (!even_levels) {
            for (std::size_t i = 10; i < 20; ++i)
                spec.levels_m[i] += 150.0 * static_cast<double>(i - 9);
        }
        const auto grid = storm_grid(spec);
        for (const int code_bytes : {1, 2}) {
            const auto bricks = bricks_of(grid, code_bytes);
            for (const Camera& camera : {Camera{180, 55, 1}, Camera{130, 80, 1.5}}) {
                const ViewGeometry geometry(spec, camera, 8, 200, 150);
                const Layer layer = slice(bricks.view(), geometry, 1024, 1, 2);
                const auto difference = against_reference(
                    {bricks.view(), nws_reflectivity(), geometry, 1}, layer, 4096, 3, 11);
                EXPECT_LT(difference.rms, 0.002);
                EXPECT_LT(difference.worst, 0.03);
            }
        }
    }
}

TEST(Slicer, MoreSlicesComeNearerToTheReference) {
    const grid::GridSpec spec = small_spec(120, 20, 4000, 800);
    const auto bricks = bricks_of(storm_grid(spec));
    const ViewGeometry geometry(spec, {180, 55, 1}, 8, 200, 150);
    double previous = 1;
    for (const int slices : {32, 128, 512}) {
        const Layer layer = slice(bricks.view(), geometry, slices, 1, 2);
        const auto difference =
            against_reference({bricks.view(), nws_reflectivity(), geometry, 1}, layer, 4096, 3, 11);
        EXPECT_LT(difference.rms, previous / 2) << slices;
        previous = difference.rms;
    }
}

// Returns codes whose code 3 would be drawn as 52 dBZ if it were a value.
grid::Quantization bright_when_ambiguous(int code_bytes = 1) {
    return {code_bytes, 52, 0.125F, true};
}

// Returns random blocks of every state, so that every case of skipping occurs.
grid::BrickGrid random_blocks(const grid::GridSpec& spec, const grid::Quantization& quantization) {
    std::mt19937 random(5);
    std::vector<Cell> blocks;
    for (int i = 0; i < 1000; ++i) {
        const auto draw = static_cast<unsigned>(random() % 20);
        blocks.push_back(draw < 3 ? valued(static_cast<double>(random() % 80) - 5)
                         : draw < 9 && quantization.has_ambiguous
                             ? Cell{CellStatus::ambiguous, 0}
                             : Cell{static_cast<CellStatus>(draw % 3), 0});
    }
    const auto grid = make_grid_of(spec, [&](int ix, int iy, int iz) {
        return blocks[static_cast<unsigned>((ix / 7) * 100 + (iy / 7) * 10 + iz / 6)];
    });
    return grid::BrickGrid::from(grid, quantization);
}

void expect_same_as_reference(const grid::BrickGrid& bricks) {
    const grid::GridSpec& spec = *bricks.view().spec;
    for (const Camera& camera : {Camera{180, 0, 1}, Camera{90, 90, 1}, Camera{180, 55, 1},
                                 Camera{222, 71, 0.8}, Camera{10, 33, 6}}) {
        const ViewGeometry geometry(spec, camera, 4, 160, 120);
        const Layer layer = slice(bricks.view(), geometry, 2048, 0.5, 2);
        const auto difference = against_reference(
            {bricks.view(), nws_reflectivity(), geometry, 0.5}, layer, 4096, 3, 11);
        EXPECT_LT(difference.rms, 0.004) << camera.azimuth_deg;
        EXPECT_LT(difference.worst, 0.06) << camera.azimuth_deg;
    }
}

TEST(Slicer, SkippingEmptyBricksChangesNothing) {
    const grid::GridSpec spec = small_spec(60, 33);
    expect_same_as_reference(random_blocks(spec, {1, -32, 0.5F}));
    for (const int code_bytes : {1, 2}) {
        SCOPED_TRACE(code_bytes);
        expect_same_as_reference(random_blocks(spec, bright_when_ambiguous(code_bytes)));
    }
}

TEST(Slicer, AmbiguousCellsAreInvisible) {
    const grid::GridSpec spec = small_spec(40, 8);
    const auto grid = make_grid_of(spec, [](int, int, int) {
        return Cell{CellStatus::ambiguous, 0};
    });
    for (const int code_bytes : {1, 2}) {
        const auto bricks = grid::BrickGrid::from(grid, bright_when_ambiguous(code_bytes));
        ASSERT_EQ(bricks.view().bricks[0].kind, grid::BrickKind::stored);
        for (const double tilt_deg : {0.0, 45.0, 90.0}) {
            const ViewGeometry geometry(spec, {180, tilt_deg, 1}, 8, 64, 48);
            for (const float channel : slice(bricks.view(), geometry, 64, 1, 1).rgba)
                ASSERT_EQ(channel, 0);
        }
    }
}

TEST(Slicer, NothingIsDrawnForCellsWithoutAValue) {
    for (const auto status :
         {CellStatus::not_seen, CellStatus::no_echo, CellStatus::range_folded}) {
        const grid::GridSpec spec = small_spec(40, 8);
        // Values below the table are invisible, but make the bricks store codes.
        const auto bricks = bricks_of(make_grid_of(spec, [&](int ix, int, int) -> Cell {
            return ix % 16 == 0 ? valued(0) : Cell{status, 0};
        }));
        const Layer layer =
            slice(bricks.view(), ViewGeometry(spec, {180, 45, 1}, 8, 64, 48), 64, 1, 1);
        for (const float channel : layer.rgba)
            ASSERT_EQ(channel, 0);
    }
}

// Next to cells without a value, whatever their state, echo keeps its own color and only fades.
TEST(Slicer, EdgesFadeInTheEchosOwnColor) {
    const grid::GridSpec spec = small_spec(40, 16);
    for (const auto status : {CellStatus::not_seen, CellStatus::no_echo, CellStatus::range_folded,
                              CellStatus::ambiguous}) {
        const auto grid = make_grid_of(spec, [&](int ix, int, int) -> Cell {
            return ix < 20 ? valued(52.125) : Cell{status, 0};
        });
        const auto bricks = grid::BrickGrid::from(grid, bright_when_ambiguous());
        const Layer layer =
            slice(bricks.view(), ViewGeometry(spec, {180, 0, 1}, 1, 400, 400), 64, 0.3, 1);
        double previous = 1;
        int fading = 0;
        for (int x = 190; x < 215; ++x) {
            const auto color = pixel_of(layer, x, 200);
            EXPECT_LE(color[3], previous + 1e-6);
            if (color[3] > 0 && color[3] < previous - 1e-6) ++fading;
            previous = color[3];
            if (color[3] > 1e-4) {
                EXPECT_NEAR(color[0] / color[3], 0xFD / 255.0, 1e-3);
            }
            EXPECT_EQ(color[1], 0);
        }
        EXPECT_EQ(previous, 0);
        EXPECT_GE(fading, 8) << "over the width of a cell, about 10 pixels";
    }
}

TEST(Slicer, TheSameBitsForAnyNumberOfThreads) {
    const grid::GridSpec spec = small_spec(100, 32, 4000, 500);
    const auto bricks = bricks_of(storm_grid(spec));
    const ViewGeometry geometry(spec, {163, 48, 1.3}, 8, 333, 222);
    const Layer one = slice(bricks.view(), geometry, 200, 1, 1);
    for (const int threads : {2, 3, 8}) {
        EXPECT_EQ(slice(bricks.view(), geometry, 200, 1, threads).rgba, one.rgba);
    }
}

TEST(Slicer, TheSameBitsForEverySimdTarget) {
    const grid::GridSpec spec = small_spec(100, 32, 4000, 500);
    const auto bricks = bricks_of(storm_grid(spec));
    const ViewGeometry geometry(spec, {163, 48, 1.3}, 8, 333, 222);
    const Layer best = slice(bricks.view(), geometry, 200, 1, 1);
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        const Layer layer = slice(bricks.view(), geometry, 200, 1, 1);
        hwy::SetSupportedTargetsForTest(0);
        EXPECT_EQ(layer.rgba, best.rgba) << hwy::TargetName(target);
    }
}

TEST(CompositeOver, MixesByOpacityAtItsPlace) {
    Image image(3, 2, {10, 20, 30, 255});
    composite_over({1, 1, {0.5F, 0.25F, 0, 0.5F}}, image, 2, 1);
    EXPECT_EQ(image.at(2, 1), (Rgba8{133, 74, 15, 255}));
    EXPECT_EQ(image.at(1, 1), (Rgba8{10, 20, 30, 255}));
    EXPECT_EQ(image.at(2, 0), (Rgba8{10, 20, 30, 255}));
}

}  // namespace
}  // namespace stormcellar::render
