#include "base/parallel.h"

#include <atomic>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(ForEachPiece, DoesEachPieceOnce) {
    for (const int threads : {0, 1, 2, 7, 100}) {
        std::vector<std::atomic<int>> done(23);
        for_each_piece(23, threads, [&](int i) { done[static_cast<std::size_t>(i)].fetch_add(1); });
        for (const auto& count : done)
            EXPECT_EQ(count.load(), 1);
    }
    for_each_piece(0, 4, [](int) { FAIL() << "there was no piece"; });
}

}  // namespace
}  // namespace stormcellar
