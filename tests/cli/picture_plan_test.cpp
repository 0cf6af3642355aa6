#include "cli/picture/picture_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/uniform_grid.h"

namespace stormcellar::cli {
namespace {

TEST(PlanPicture, ABudgetThatNothingKeepsIsUnmet) {
    const auto bricks = grid::BrickGrid::from(testing::uniform_grid("20050822_024400", 33, 20),
                                              grid::default_quantization(level2::Moment::ref));
    const auto planned = [&](const std::string& tolerance) {
        render::Scene scene;
        scene.width = 400;
        scene.height = 300;
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
    EXPECT_EQ(slip.error().code, ErrorCode::bad_argument) << "the text is not a budget";
}

}  // namespace
}  // namespace stormcellar::cli
