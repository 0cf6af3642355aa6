#include "base/parallel.h"

#include <atomic>
#include <new>
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

TEST(ForEachPiece, WhatOneThrowsComesToTheCaller) {
    for (const int threads : {1, 2, 7}) {
        std::atomic<int> begun = 0;
        const auto work = [&](int i) {
            ++begun;
            if (i >= 5) throw std::bad_alloc{};
        };
        EXPECT_THROW(for_each_piece(10'000, threads, work), std::bad_alloc);
        EXPECT_LE(begun.load(), 5 + 7);
    }
}

}  // namespace
}  // namespace stormcellar
