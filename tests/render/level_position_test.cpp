#include "render/volume/level_position.h"

#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

double slow_position(const std::vector<double>& levels, double height) {
    if (height <= levels.front()) return 0;
    for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
        if (height < levels[i + 1]) {
            return static_cast<double>(i) + (height - levels[i]) / (levels[i + 1] - levels[i]);
        }
    }
    return static_cast<double>(levels.size() - 1);
}

TEST(LevelPosition, AgreesWithASearchForLevelsOfAnySpacing) {
    const std::vector<std::vector<double>> ladders = {
        {500, 1000, 1500, 2000},
        {500, 750, 1000, 3000, 3500, 9000, 19000},
        {0, 1, 2, 30000, 30001},
        {-500, 12000},
    };
    for (const auto& levels : ladders) {
        grid::GridSpec spec;
        spec.levels_m = levels;
        const double exaggeration = 8;
        const LevelPosition position(spec, exaggeration);
        const double span = levels.back() - levels.front();
        for (int i = -50; i <= 5050; ++i) {
            const double height = levels.front() + span * i / 5000;
            EXPECT_NEAR(static_cast<double>(position(static_cast<float>(height * exaggeration))),
                        slow_position(levels, height), 0.03)
                << height;
        }
        for (std::size_t i = 0; i < levels.size(); ++i) {
            EXPECT_EQ(position(static_cast<float>(levels[i] * exaggeration)),
                      static_cast<float>(i));
        }
    }
}

TEST(LevelPosition, KnowsLevelsAtOneSpacing) {
    grid::GridSpec spec;
    spec.levels_m = {500, 1000, 1500, 2000};
    const LevelPosition even(spec, 8);
    EXPECT_TRUE(even.is_uniform());
    EXPECT_NEAR(even.offset() + even.slope() * 8 * 1250, 1.5, 1e-12);
    spec.levels_m = {500, 1000, 1501};
    EXPECT_FALSE(LevelPosition(spec, 8).is_uniform());
    spec.levels_m = {700};
    EXPECT_TRUE(LevelPosition(spec, 8).is_uniform());
    EXPECT_EQ(LevelPosition(spec, 8)(12345), 0);
}

}  // namespace
}  // namespace stormcellar::render
