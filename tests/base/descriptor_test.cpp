#include "stormcellar/base/descriptor.h"

#include <array>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>

namespace stormcellar {
namespace {

bool stands(int number) {
    return ::fcntl(number, F_GETFD) >= 0;
}

TEST(Descriptor, IsClosedByItsLastHolder) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    {
        Descriptor first{ends[0]};
        EXPECT_TRUE(first.is_open());
        Descriptor second{std::move(first)};
        EXPECT_EQ(second.number(), ends[0]);
        Descriptor third;
        EXPECT_FALSE(third.is_open());
        third = std::move(second);
        EXPECT_EQ(third.number(), ends[0]);
        EXPECT_TRUE(stands(ends[0]));
    }
    EXPECT_FALSE(stands(ends[0]));
    {
        Descriptor given{ends[1]};
        EXPECT_EQ(given.release(), ends[1]);
        EXPECT_FALSE(given.is_open());
    }
    EXPECT_TRUE(stands(ends[1])) << "a released descriptor stays open";
    ::close(ends[1]);
}

}  // namespace
}  // namespace stormcellar
