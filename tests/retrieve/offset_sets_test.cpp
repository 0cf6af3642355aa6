#include "retrieve/dealias/offset_sets.h"

#include <random>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

// Every member has a value. The sets learn differences of these values by joins, in random order.
TEST(OffsetSets, KnowEveryDifferenceInsideASet) {
    std::mt19937 random(7);
    std::uniform_int_distribution<std::int32_t> member(0, 199), value(-9, 9);
    std::vector<std::int32_t> values(200);
    for (auto& one : values)
        one = value(random);
    OffsetSets sets(200);
    for (int i = 0; i < 500; ++i) {
        const std::int32_t a = member(random), b = member(random);
        const auto difference =
            values[static_cast<std::size_t>(b)] - values[static_cast<std::size_t>(a)];
        const bool is_known = sets.find(a).root == sets.find(b).root;
        EXPECT_EQ(sets.join(a, b, difference), !is_known);
        const std::int32_t c = member(random);
        const auto found = sets.find(c);
        EXPECT_EQ(found.offset, values[static_cast<std::size_t>(c)] -
                                    values[static_cast<std::size_t>(found.root)]);
    }
}

TEST(OffsetSets, AKnownDifferenceStays) {
    OffsetSets sets(3);
    EXPECT_TRUE(sets.join(0, 1, 2));
    EXPECT_FALSE(sets.join(0, 1, 5));
    EXPECT_EQ(sets.find(1).offset - sets.find(0).offset, 2);
}

}  // namespace
}  // namespace stormcellar::retrieve
