#include "grid/cells/level_range.h"

#include <gtest/gtest.h>

#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::grid {
namespace {

TEST(LevelRange, KilometresAreWholeMillimetres) {
    EXPECT_EQ(metres_of_km(0.1), 100);
    EXPECT_EQ(metres_of_km(1.001), 1001) << "1.001 * 1000 is less";
    EXPECT_EQ(metres_of_km(-0.3), -300);
}

TEST(LevelRange, TheTopIsReachedButForRounding) {
    EXPECT_EQ(parse_level_range("0.1:0.7:0.2"), (std::vector<double>{100, 300, 500, 700}));
    EXPECT_EQ(parse_level_range("0.1:1:0.4"), (std::vector<double>{100, 500, 900}));
    EXPECT_EQ(parse_level_range("2:2:1"), std::vector<double>{2000});
    EXPECT_EQ(parse_level_range("0.5:16:0.5"), default_spec(40, -80).levels_m);
}

TEST(LevelRange, WhatIsNoRangeIsRefused) {
    for (const char* text : {"1:2", "1:2:3:4", "2:1:0.5", "1:2:0", "1:2:-1", "a:2:1", "1:2:1 "})
        EXPECT_FALSE(parse_level_range(text)) << text;
}

TEST(LevelRange, HasNoMoreLevelsThanAGrid) {
    EXPECT_EQ(parse_level_range("0:10.23:0.01")->size(),
              static_cast<std::size_t>(GridSpec::greatest_level_count));
    EXPECT_FALSE(parse_level_range("0:10.24:0.01"));
    EXPECT_FALSE(parse_level_range("1:2:1e-300"));
}

}  // namespace
}  // namespace stormcellar::grid
