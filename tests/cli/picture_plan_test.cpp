#include "cli/picture/picture_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cli {
namespace {

grid::BrickGrid small_grid() {
    grid::Grid grid;
    grid.spec = grid::default_spec(42.2, -75.98);
    grid.spec.nx = grid.spec.ny = 20;
    grid.values.assign(grid.spec.cell_count(), 33);
    grid.status.assign(grid.spec.cell_count(), grid::CellStatus::value);
    return grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
}

TEST(PlanPicture, ABudgetThatNothingKeepsIsUnmet) {
    const grid::BrickGrid bricks = small_grid();
    const auto planned = [&](const std::string& tolerance) {
        render::Scene scene;
        scene.width = 320;
        scene.height = 200;
        PicturePlanOptions options;
        options.tolerance = tolerance;
        return plan_picture(bricks.view(), {"KBGM", level2::Moment::ref, {}, {}}, options, false, 1,
                            scene);
    };
    // No picture is drawn in a millionth of a second.
    const auto refused = planned("0.001 ms");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unmet);
    EXPECT_THAT(refused.error().message, ::testing::HasSubstr("budget of"));
    const auto met = planned("1000 s");
    EXPECT_TRUE(met) << met.error().message;
    const auto slip = planned("soon");
    ASSERT_FALSE(slip);
    EXPECT_EQ(slip.error().code, ErrorCode::bad_argument) << "no budget at all";
}

}  // namespace
}  // namespace stormcellar::cli
