#include "base/recently_used.h"

#include <string>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

// A key without an order, which can only be compared for equality.
struct Unordered {
    int number = 0;
    bool operator==(const Unordered&) const = default;
};
struct Ordered {
    int number = 0;
    auto operator<=>(const Ordered&) const = default;
};

template <class Key>
class RecentlyUsedTest : public ::testing::Test {};
using Keys = ::testing::Types<Unordered, Ordered>;
TYPED_TEST_SUITE(RecentlyUsedTest, Keys);

TYPED_TEST(RecentlyUsedTest, TheLeastRecentlyUsedGoesFirst) {
    RecentlyUsed<TypeParam, std::string> kept({.values = 2});
    kept.keep({1}, "one");
    kept.keep({2}, "two");
    ASSERT_NE(kept.find({1}), nullptr);
    kept.keep({3}, "three");
    EXPECT_EQ(kept.find({2}), nullptr) << "2 is the least recently used key";
    EXPECT_EQ(*kept.find({1}), "one");
    EXPECT_EQ(*kept.find({3}), "three");
    EXPECT_EQ(kept.size(), 2U);
}

TYPED_TEST(RecentlyUsedTest, WeightsCountAndTheNewestStays) {
    RecentlyUsed<TypeParam, int> kept({.weight = 10});
    kept.keep({1}, 1, 4);
    kept.keep({2}, 2, 6);
    EXPECT_EQ(kept.weight(), 10U);
    kept.keep({3}, 3, 1);
    EXPECT_EQ(kept.find({1}), nullptr);
    EXPECT_EQ(kept.weight(), 7U);
    kept.keep({4}, 4, 11);
    EXPECT_EQ(kept.size(), 1U) << "a value that exceeds the budget drops all others";
    EXPECT_NE(kept.find({4}), nullptr);
}

TYPED_TEST(RecentlyUsedTest, AKeyHasOneValue) {
    RecentlyUsed<TypeParam, int> kept({.weight = 10});
    kept.keep({1}, 1, 4);
    EXPECT_EQ(kept.keep({1}, 2, 3), 2);
    EXPECT_EQ(kept.size(), 1U);
    EXPECT_EQ(kept.weight(), 3U);
    kept.drop({1});
    kept.drop({1});
    EXPECT_EQ(kept.find({1}), nullptr);
    EXPECT_EQ(kept.weight(), 0U);
}

TYPED_TEST(RecentlyUsedTest, ThoseThatARuleNamesAreDropped) {
    RecentlyUsed<TypeParam, int> kept({});
    for (int i = 0; i < 6; ++i)
        kept.keep({i}, i);
    kept.drop_if([](const TypeParam& key) { return key.number % 2 == 0; });
    EXPECT_EQ(kept.size(), 3U);
    EXPECT_EQ(kept.find({2}), nullptr);
    EXPECT_EQ(*kept.find({5}), 5);
}

}  // namespace
}  // namespace stormcellar
