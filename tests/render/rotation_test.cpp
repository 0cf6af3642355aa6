#include "render/products/rotation.h"

#include <cmath>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "stormcellar/grid/gridder.h"
#include "stormcellar/render/render.h"
#include "tests/render/real_volume.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;
using level2::Moment;

constexpr int shear_nx = 40, shear_ny = 36, shear_nz = 20;

grid::GridSpec spec_of_shear() {
    grid::GridSpec spec = grid::default_spec(35, -97);
    spec.nx = shear_nx;
    spec.ny = shear_ny;
    spec.levels_m.clear();
    for (int z = 0; z < shear_nz; ++z)
        spec.levels_m.push_back(500.0 * (z + 1));
    return spec;
}

// Makes a grid from the shear of each cell in 0.001/s; cells without a value are ambiguous.
grid::BrickGrid shear_bricks(const std::function<std::optional<float>(int, int, int)>& shear_at) {
    grid::Grid grid;
    grid.spec = spec_of_shear();
    grid.moment = Moment::azsh;
    grid.values.assign(static_cast<std::size_t>(shear_nx) * shear_ny * shear_nz, 0);
    grid.status.assign(grid.values.size(), CellStatus::ambiguous);
    for (int z = 0; z < shear_nz; ++z) {
        for (int y = 0; y < shear_ny; ++y) {
            for (int x = 0; x < shear_nx; ++x) {
                const auto shear = shear_at(x, y, z);
                if (!shear) continue;
                grid.values[grid.spec.index(x, y, z)] = *shear;
                grid.status[grid.spec.index(x, y, z)] = CellStatus::value;
            }
        }
    }
    return grid::BrickGrid::from(grid, grid::default_quantization(Moment::azsh));
}

// Returns the number of cells whose share says that they are in a column.
int count_column_cells(const grid::BrickGrid& columns) {
    int count = 0;
    const grid::BrickView view = columns.view();
    for (int x = 0; x < shear_nx; ++x)
        for (int y = 0; y < shear_ny; ++y)
            for (int z = 0; z < shear_nz; ++z)
                count += view.status(x, y, z) == CellStatus::value &&
                                 std::abs(view.value(x, y, z)) >= column_share
                             ? 1
                             : 0;
    return count;
}

TEST(Rotation, StrongCellsAboveEachOtherMakeAColumn) {
    const auto shear = shear_bricks([](int x, int y, int) {
        return x == 10 && y == 12 ? least_rotation : x == 30 && y == 5 ? -20.0F : 1.0F;
    });
    const auto columns = rotation_columns(shear.view());
    const grid::BrickView view = columns.view();
    // Across the column, half of the weight is on the cell. Along the column, all of the weight is
    // in the column.
    EXPECT_NEAR(view.value(10, 12, 9), 0.25, 0.006);
    EXPECT_NEAR(view.value(30, 5, 9), -0.25, 0.006);
    EXPECT_NEAR(view.value(11, 12, 9), 0.125, 0.006);
    EXPECT_NEAR(view.value(12, 12, 9), 0, 0.006);
    EXPECT_EQ(view.status(20, 20, 9), CellStatus::not_seen);
    EXPECT_EQ(count_column_cells(columns), 2 * (shear_nz - 2))
        << "the ends have three quarters of the weight";
}

TEST(Rotation, WeakSingleAndShallowCellsMakeNoColumn) {
    const auto count = [](const std::function<std::optional<float>(int, int, int)>& shear_at) {
        return count_column_cells(rotation_columns(shear_bricks(shear_at).view()));
    };
    EXPECT_EQ(count([](int x, int, int) { return x % 9 == 4 ? 7.9F : 0.0F; }), 0);
    EXPECT_EQ(count([](int x, int y, int z) { return (x + y) % 7 == 0 && z == 4 ? 50.0F : 0.0F; }),
              0);
    const auto wide_and_deep = [&](int levels) {
        return count([levels](int x, int y, int z) {
            const bool is_in = std::abs(x - 10) < 3 && std::abs(y - 12) < 3 && z < levels;
            return is_in ? 30.0F : 0.0F;
        });
    };
    EXPECT_EQ(wide_and_deep(4), 0) << "1.5 km deep";
    EXPECT_GE(wide_and_deep(5), 5 * 25) << "2 km deep";
    EXPECT_EQ(count([](int x, int y, int z) {
                  const float sense = z % 2 == 0 ? 30 : -30;
                  return x == 10 && y == 12 ? sense : 0.0F;
              }),
              0);
    EXPECT_EQ(count([](int, int, int) { return std::optional<float>{}; }), 0)
        << "ambiguous cells are no rotation";
}

// Columns at the edges of bricks and of the grid.
TEST(Rotation, AColumnMayLeanAcrossBricksAndTouchTheEdge) {
    const auto shear = shear_bricks(
        [](int x, int y, int z) { return y == 0 && x >= z && x < z + 3 ? 12.0F : 0.0F; });
    const auto columns = rotation_columns(shear.view());
    for (int z = 0; z < shear_nz; ++z)
        EXPECT_GE(columns.view().value(z + 1, 0, z), column_share) << z;
}

TEST(Rotation, ItsColorsAreAValidTable) {
    const ColorTable table = rotation_colors();
    EXPECT_TRUE(validate(table));
    EXPECT_EQ(extinction_per_m(table, column_share - 0.01, 1), 0);
    EXPECT_EQ(extinction_per_m(table, -column_share + 0.01, 1), 0);
    EXPECT_GT(extinction_per_m(table, 0.5, 1), 0);
    EXPECT_EQ(color_of(table, 0.5F), cyclonic_color);
    EXPECT_EQ(color_of(table, -0.5F), anticyclonic_color);
}

// Draws an empty volume with a column of each sense, the counterclockwise one in the west.
TEST(Rotation, APictureShowsEachColumnInItsColor) {
    const auto shear = shear_bricks([](int x, int y, int) {
        const bool is_high = std::abs(y - 18) < 3;
        return is_high && std::abs(x - 10) < 3   ? 20.0F
               : is_high && std::abs(x - 30) < 3 ? -20.0F
                                                 : 0.0F;
    });
    const auto columns = rotation_columns(shear.view());
    const grid::BrickGrid echo(spec_of_shear(), grid::default_quantization(Moment::ref));
    Scene scene;
    scene.width = 300;
    scene.height = 200;
    scene.labels = false;
    scene.camera.tilt_deg = 60;
    const FrameFacts facts{"KTLX", Moment::ref, {}, {{"KTLX", 35, -97, 400}}};
    const grid::BrickView rotation = columns.view();
    const Image with =
        render_frame(echo.view(), facts, scene, 2, nullptr, {.rotation = &rotation}).value();
    const Image without = render_frame(echo.view(), facts, scene, 2).value();
    int west = 0, east = 0, wrong = 0;
    for (int y = 0; y < 200; ++y) {
        for (int x = 0; x < 300; ++x) {
            const Rgba8 color = with.at(x, y);
            const Rgba8 ground = without.at(x, y);
            const int more_blue = color[2] - ground[2];
            const int more_green = color[1] - ground[1];
            if (std::abs(more_blue) + std::abs(more_green) < 6) continue;
            const bool is_blue = more_blue > more_green;
            if (is_blue != (x < 150)) ++wrong;
            (x < 150 ? west : east) += 1;
        }
    }
    EXPECT_GT(west, 500);
    EXPECT_GT(east, 500);
    EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace stormcellar::render
