// Tests lookups against a search of all levels.
#include "grid/cells/level_table.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

std::size_t slow_first_from(const std::vector<float>& levels_m, float height_m) {
    std::size_t level = 0;
    while (level < levels_m.size() && !(levels_m[level] >= height_m))
        ++level;
    return level;
}

std::vector<std::vector<float>> hard_levels() {
    std::vector<std::vector<float>> all = {
        {500},
        {0, 1e-3F},
        {-400, -399.99F, 0, 20000},
        {1000, std::nextafter(1000.0F, 2000.0F), std::nextafter(1000.0F, 2000.0F) + 1},
        {100, 200, 400, 800, 1600, 3200, 6400, 12800, 25600}};
    std::vector<float> regular, third;
    for (int i = 1; i <= 128; ++i) {
        regular.push_back(125.0F * static_cast<float>(i));
        third.push_back(static_cast<float>(i) / 3);
    }
    all.push_back(regular);
    all.push_back(third);
    return all;
}

TEST(LevelTable, FindsTheFirstLevelFromAHeight) {
    std::mt19937_64 random(4);
    for (const std::vector<float>& levels_m : hard_levels()) {
        const LevelTable table(levels_m);
        const auto agrees = [&](float height_m) {
            EXPECT_EQ(table.first_from(height_m), slow_first_from(levels_m, height_m)) << height_m;
        };
        for (const float level_m : levels_m) {
            agrees(level_m);
            agrees(std::nextafter(level_m, 1e9F));
            agrees(std::nextafter(level_m, -1e9F));
        }
        const float span_m = levels_m.back() - levels_m.front() + 10;
        std::uniform_real_distribution<float> height(levels_m.front() - 0.2F * span_m,
                                                     levels_m.back() + 0.2F * span_m);
        for (int i = 0; i < 20000; ++i)
            agrees(height(random));
        for (const float extreme : {-1e9F, 1e9F, std::numeric_limits<float>::infinity()}) {
            agrees(extreme);
            agrees(-extreme);
        }
    }
}

}  // namespace
}  // namespace stormcellar::grid
