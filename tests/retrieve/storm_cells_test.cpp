// Tests that storm cells are found where a simulated radar sees storms, with the attributes of the
// storms, and that cases without storms give no cells.
#include "stormcellar/retrieve/storm_cells.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/retrieve/cells_scene.h"

namespace stormcellar::retrieve {
namespace {

constexpr UtcTime noon{std::chrono::hours(12)};

const std::vector<SceneStorm> six_storms = {
    {-70, 20, 15, 8}, {-30, 70, 14, 6},  {20, -60, 17, 9},
    {40, 30, 12, 10}, {70, -20, 15, 12}, {-60, -60, 18, 4},
};

// A grid without echo, whose cells tests may set.
grid::Grid quiet_grid(int side, std::vector<double> levels_m) {
    grid::Grid quiet;
    quiet.spec = grid::default_spec(35, -97);
    quiet.spec.nx = quiet.spec.ny = side;
    quiet.spec.levels_m = std::move(levels_m);
    quiet.values.assign(quiet.spec.cell_count(), 0.0F);
    quiet.status.assign(quiet.spec.cell_count(), grid::CellStatus::no_echo);
    return quiet;
}

void set_cell(grid::Grid& grid, int ix, int iy, int iz, float dbz) {
    const std::size_t at = grid.spec.index(ix, iy, iz);
    grid.values[at] = dbz;
    grid.status[at] = grid::CellStatus::value;
}

std::vector<StormCell> cells_of(const grid::Grid& grid, const CellOptions& options = {}) {
    const auto bricks =
        grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
    const auto scan = find_cells({bricks.view(), {}, {}}, noon, "KTLX", options);
    EXPECT_TRUE(scan) << scan.error().message;
    return scan ? scan->cells : std::vector<StormCell>{};
}

TEST(StormCells, FindsSixStormsAndNoOthers) {
    const synth::Scene scene = cells_scene(six_storms);
    for (int number = 0; number < 3; ++number) {
        const grid::BrickGrid bricks = gridded_scene(scene, number);
        const auto scan = find_cells({bricks.view(), {}, FreezingLevels{}},
                                     scene.schedule.start_of(number), "KTLX");
        ASSERT_TRUE(scan) << scan.error().message;
        EXPECT_EQ(scan->cells.size(), six_storms.size());
        for (const SceneStorm& storm : six_storms) {
            double nearest_m = 1e9;
            for (const StormCell& cell : scan->cells)
                nearest_m = std::min(nearest_m,
                                     between_m(cell.position, storm_place(scene, storm, number)));
            EXPECT_LT(nearest_m, 2000) << storm.x_km << ", " << storm.y_km;
        }
    }
}

TEST(StormCells, MeasureTheStorm) {
    const SceneStorm storm{0, 60, 0, 0};
    const synth::Scene scene = cells_scene({storm});
    const grid::BrickGrid bricks = gridded_scene(scene, 0);
    const auto scan = find_cells({bricks.view(), {}, FreezingLevels{}}, noon, "KTLX");
    ASSERT_TRUE(scan);
    ASSERT_EQ(scan->cells.size(), 1U);
    const StormCell& cell = scan->cells.front();
    EXPECT_NEAR(cell.max_dbz, 55, 1);
    // Reflectivity is 55 - 45 r^2, so 35 dBZ is at two thirds of the radius.
    EXPECT_NEAR(cell.area_km2, std::numbers::pi * 64, 15);
    // Above the core, 18 dBZ is at 3 + 10 sqrt(37 / 45) = 12.07 km, which the highest sweep, of
    // 9.8 degrees at 60 km, does not reach.
    EXPECT_TRUE(cell.top_is_at_least);
    EXPECT_GT(cell.top_m, 9000);
    EXPECT_LT(cell.top_m, 12070);
    EXPECT_FALSE(cell.azimuthal_shear_per_s);
    ASSERT_TRUE(cell.mesh_mm);
    EXPECT_GT(*cell.mesh_mm, 5);
    // The least hail is for higher freezing levels and the most for lower freezing levels, so MESH
    // is in between.
    ASSERT_TRUE(cell.mesh_range);
    EXPECT_LT(cell.mesh_range->least_mm, *cell.mesh_mm);
    EXPECT_GT(cell.mesh_range->most_mm, *cell.mesh_mm);
    EXPECT_EQ(scan->freezing, FreezingLevels{});
}

TEST(StormCells, TopIsExactWhereTheAirAboveWasSeen) {
    const SceneStorm storm{0, 100, 0, 0};
    const grid::BrickGrid bricks = gridded_scene(cells_scene({storm}), 0);
    const auto scan = find_cells({bricks.view(), {}, {}}, noon, "KTLX");
    ASSERT_TRUE(scan);
    ASSERT_EQ(scan->cells.size(), 1U);
    EXPECT_FALSE(scan->cells.front().top_is_at_least);
    EXPECT_NEAR(scan->cells.front().top_m, 12070, 750);
    EXPECT_FALSE(scan->cells.front().mesh_mm);  // without freezing levels
    EXPECT_FALSE(scan->cells.front().mesh_range);
    EXPECT_FALSE(scan->freezing);
}

TEST(StormCells, VilOfAColumnIsThatOfGreeneAndClark) {
    grid::Grid grid = quiet_grid(20, {1000, 2000, 3000, 4000, 5000});
    for (int ix = 5; ix < 12; ++ix) {
        for (int iy = 5; iy < 12; ++iy) {
            for (int iz = 0; iz < 4; ++iz)
                set_cell(grid, ix, iy, iz, 50);
        }
    }
    const auto cells = cells_of(grid);
    ASSERT_EQ(cells.size(), 1U);
    // Counts half a layer below, three whole layers, and a layer with the mean of 50 dBZ and no
    // echo.
    const double vil = 3.44e-6 * (3500 * std::pow(1e5, 4.0 / 7) + 1000 * std::pow(0.5e5, 4.0 / 7));
    EXPECT_NEAR(cells[0].vil_kg_per_m2, vil, 1e-4 * vil);
    EXPECT_EQ(cells[0].area_km2, 49);
    EXPECT_EQ(cells[0].top_m, 4000);
    EXPECT_FALSE(cells[0].top_is_at_least);
    EXPECT_EQ(cells[0].max_dbz_height_m, 1000);
    const std::vector<ColumnRun> rows = {{5, 5, 12}, {6, 5, 12},  {7, 5, 12}, {8, 5, 12},
                                         {9, 5, 12}, {10, 5, 12}, {11, 5, 12}};
    EXPECT_EQ(cells[0].columns, rows);
}

// The lowest beam is between the first two levels.
TEST(StormCells, VilCountsTheAirBelowTheLowestBeam) {
    grid::Grid grid = quiet_grid(20, {1000, 2000, 3000, 4000, 5000});
    for (int ix = 5; ix < 12; ++ix) {
        for (int iy = 5; iy < 12; ++iy) {
            grid.status[grid.spec.index(ix, iy, 0)] = grid::CellStatus::not_seen;
            for (int iz = 1; iz < 5; ++iz)
                set_cell(grid, ix, iy, iz, 50);
        }
    }
    const auto bricks =
        grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
    const auto vil_with = [&](std::optional<double> radar_m) {
        CellFields fields{bricks.view(), {}, {}};
        fields.radar_m = radar_m;
        const auto scan = find_cells(fields, noon, "KTLX");
        EXPECT_EQ(scan->cells.size(), 1U);
        return scan->cells.at(0).vil_kg_per_m2;
    };
    const double per_m = 3.44e-6 * std::pow(1e5, 4.0 / 7);
    EXPECT_NEAR(vil_with(std::nullopt), 4000 * per_m, 0.4 * per_m);
    EXPECT_NEAR(vil_with(700), 4800 * per_m, 0.5 * per_m);
}

TEST(StormCells, CellsOfALineSeparate) {
    std::vector<SceneStorm> line;
    for (int i = 0; i < 6; ++i)
        line.push_back({-50.0 + 12 * i, 50.0 + 4 * i, 0, 0, 10});
    const grid::BrickGrid bricks = gridded_scene(cells_scene(line), 0);
    const auto scan = find_cells({bricks.view(), {}, {}}, noon, "KTLX");
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->cells.size(), line.size());
}

TEST(StormCells, PeaksAboveEachOtherAreOneCell) {
    grid::Grid grid = quiet_grid(30, {1000, 2000, 3000, 4000, 5000, 6000, 7000});
    for (int ix = 8; ix < 16; ++ix) {
        for (int iy = 8; iy < 16; ++iy) {
            for (int iz = 0; iz < 7; ++iz)
                set_cell(grid, ix, iy, iz, iz == 3 ? 40.0F : 55.0F);
        }
    }
    EXPECT_EQ(cells_of(grid).size(), 1U);
}

// 2026-11-30: cells near KDMX, in a volume of two low sweeps, were left out as too thin.
TEST(StormCells, EchoThatMayBeDeepIsNotThin) {
    grid::Grid grid = quiet_grid(30, {1000, 2000, 3000, 4000, 5000});
    for (int ix = 8; ix < 16; ++ix) {
        for (int iy = 8; iy < 16; ++iy)
            set_cell(grid, ix, iy, 1, 55);
    }
    EXPECT_TRUE(cells_of(grid).empty());  // a layer of 1 km with clear air above
    for (int ix = 0; ix < 30; ++ix) {
        for (int iy = 0; iy < 30; ++iy)
            grid.status[grid.spec.index(ix, iy, 2)] = grid::CellStatus::not_seen;
    }
    const auto cells = cells_of(grid);
    ASSERT_EQ(cells.size(), 1U);
    EXPECT_TRUE(cells[0].top_is_at_least);
}

TEST(StormCells, GridsWithoutStormsHaveNone) {
    EXPECT_TRUE(cells_of(quiet_grid(40, {1000, 2000})).empty());
    grid::Grid unseen = quiet_grid(40, {1000, 2000});
    unseen.status.assign(unseen.status.size(), grid::CellStatus::not_seen);
    EXPECT_TRUE(cells_of(unseen).empty());
    grid::Grid speckle = quiet_grid(40, {1000, 2000, 3000});
    set_cell(speckle, 20, 20, 1, 60);
    EXPECT_TRUE(cells_of(speckle).empty());
}

TEST(StormCells, AGridOfOneCellMayBeAStorm) {
    grid::Grid one = quiet_grid(1, {1000});
    EXPECT_TRUE(cells_of(one).empty());
    set_cell(one, 0, 0, 0, 50);
    EXPECT_TRUE(cells_of(one).empty());  // 1 km2 is too small
    one.spec.spacing_m = 4000;
    const auto cells = cells_of(one);
    ASSERT_EQ(cells.size(), 1U);
    EXPECT_EQ(cells[0].area_km2, 16);
    EXPECT_TRUE(cells[0].top_is_at_least);
    EXPECT_TRUE(std::isfinite(cells[0].vil_kg_per_m2));
}

// A melting layer of 39 to 45 dBZ within 60 km of the radar. Farther away, the beams are so far
// apart that the layer looks deep.
TEST(StormCells, StratiformRainWithAMeltingLayerHasNone) {
    const synth::Scene scene = cells_scene({}, R"([[layer]]
position_km = [0, 0]
radii_km = [90, 90]
base_km = 0
top_km = 9
peak_dbz = 27
melting_km = 3
bright_band_db = 15
bright_band_depth_km = 0.3
ripple_db = 3
)");
    const grid::BrickGrid bricks = gridded_scene(scene, 0);
    const auto scan = find_cells({bricks.view(), {}, {}}, noon, "KTLX");
    ASSERT_TRUE(scan);
    EXPECT_TRUE(scan->cells.empty()) << scan->cells.size();
    // There is strong echo: with a least depth of 0, it makes cells.
    CellOptions thin;
    thin.least_depth_m = 0;
    const auto layers = find_cells({bricks.view(), {}, {}}, noon, "KTLX", thin);
    ASSERT_TRUE(layers);
    EXPECT_FALSE(layers->cells.empty());
}

TEST(StormCells, TakeTheLargestAzimuthalShearWithinTheirEcho) {
    grid::Grid grid = quiet_grid(20, {1000, 2000, 3000, 4000});
    grid::Grid shear = grid;
    shear.moment = level2::Moment::azsh;
    for (int ix = 5; ix < 12; ++ix) {
        for (int iy = 5; iy < 12; ++iy) {
            for (int iz = 0; iz < 4; ++iz)
                set_cell(grid, ix, iy, iz, 50);
        }
    }
    set_cell(shear, 6, 6, 1, 10);
    set_cell(shear, 7, 6, 2, 4);
    set_cell(shear, 18, 18, 1, 30);  // without echo
    const auto bricks =
        grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
    const auto sheared =
        grid::BrickGrid::from(shear, grid::default_quantization(level2::Moment::azsh));
    const auto scan = find_cells({bricks.view(), sheared.view(), {}}, noon, "KTLX");
    ASSERT_TRUE(scan) << scan.error().message;
    ASSERT_EQ(scan->cells.size(), 1U);
    ASSERT_TRUE(scan->cells[0].azimuthal_shear_per_s);
    EXPECT_NEAR(*scan->cells[0].azimuthal_shear_per_s, 0.01, 1e-4);
}

TEST(StormCells, BadArgumentsAreErrors) {
    const grid::Grid grid = quiet_grid(4, {1000, 2000});
    const auto quantization = grid::default_quantization(level2::Moment::ref);
    const auto bricks = grid::BrickGrid::from(grid, quantization);
    EXPECT_FALSE(find_cells({}, noon, "KTLX"));
    CellOptions options;
    options.prominence_db = std::nanf("");
    EXPECT_FALSE(find_cells({bricks.view(), {}, {}}, noon, "KTLX", options));
    EXPECT_FALSE(find_cells({bricks.view(), {}, FreezingLevels{5000, 4000}}, noon, "KTLX"));
    const auto other = grid::BrickGrid::from(quiet_grid(5, {1000, 2000}), quantization);
    EXPECT_FALSE(find_cells({bricks.view(), other.view(), {}}, noon, "KTLX"));
    CellScan scan = *find_cells({bricks.view(), {}, {}}, noon, "KTLX");
    EXPECT_FALSE(guess_motions(scan, bricks.view(), other.view(), 300));
    EXPECT_FALSE(guess_motions(scan, bricks.view(), bricks.view(), 0));
    EXPECT_FALSE(guess_motions(scan, other.view(), bricks.view(), 300));
    EXPECT_TRUE(guess_motions(scan, bricks.view(), bricks.view(), 300));  // too little echo
}

}  // namespace
}  // namespace stormcellar::retrieve
