#include "stormcellar/base/sparse_bytes.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(SparseBytes, AreZerosOfEverySize) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{5000},
                                   std::size_t{32} << 20, (std::size_t{40} << 20) + 7}) {
        const SparseBytes made(size);
        ASSERT_EQ(made.bytes().size(), size);
        EXPECT_TRUE(std::all_of(made.bytes().begin(), made.bytes().end(),
                                [](std::byte byte) { return byte == std::byte{0}; }));
    }
}

// This test examines moved objects: NOLINTBEGIN(bugprone-use-after-move)
TEST(SparseBytes, MovesLeaveTheSourceEmpty) {
    for (const std::size_t size : {std::size_t{100}, std::size_t{33} << 20}) {
        SparseBytes first(size);
        first.data()[size - 1] = std::byte{7};
        SparseBytes second(std::move(first));
        EXPECT_EQ(first.size(), 0U);
        EXPECT_EQ(second.bytes()[size - 1], std::byte{7});
        SparseBytes third(10);
        third = std::move(second);
        EXPECT_EQ(second.size(), 0U);
        EXPECT_EQ(third.bytes().size(), size);
        EXPECT_EQ(third.bytes()[size - 1], std::byte{7});
    }
}
// NOLINTEND(bugprone-use-after-move)

// The test writes one page in each GiB of 64 GiB.
TEST(SparseBytes, TakeMemoryOnlyWhereTheyAreWritten) {
    constexpr std::size_t gibibyte = std::size_t{1} << 30;
    SparseBytes made(64 * gibibyte);
    for (std::size_t i = 0; i < 64; ++i)
        made.data()[i * gibibyte] = static_cast<std::byte>(i);
    EXPECT_EQ(made.bytes()[50 * gibibyte], std::byte{50});
    EXPECT_EQ(made.bytes()[50 * gibibyte + 1], std::byte{0});
}

}  // namespace
}  // namespace stormcellar
