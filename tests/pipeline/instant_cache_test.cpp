#include "pipeline/mosaic/instant_cache.h"

#include <gtest/gtest.h>

namespace stormcellar::pipeline {
namespace {

using Key = InstantCache::Key;

// Returns a grid of one stored brick of 4,096 bytes and a table of 24 bytes.
std::shared_ptr<const grid::BrickGrid> one_brick() {
    grid::Grid made;
    made.spec = grid::default_spec(40, -100);
    made.spec.nx = made.spec.ny = 16;
    made.spec.levels_m = {1000};
    made.values.assign(made.spec.cell_count(), 10);
    made.status.assign(made.spec.cell_count(), grid::CellStatus::value);
    return std::make_shared<const grid::BrickGrid>(grid::BrickGrid::from(made, {}));
}

TEST(InstantCache, TheLeastRecentlyUsedGoesFirst) {
    constexpr std::size_t one = 4096 + 24;
    InstantCache cache(2 * one);
    const Key a{1, 2, 3, {}}, b{1, 2, 4, {}}, c{5, 2, 3, {}};
    EXPECT_EQ(cache.find(a), nullptr);
    const auto grid = one_brick();
    cache.keep(a, grid);
    cache.keep(a, one_brick());
    EXPECT_EQ(cache.find(a), grid) << "the first grid should be kept";
    EXPECT_EQ(cache.bytes(), one);
    cache.keep(b, one_brick());
    EXPECT_EQ(cache.find(a), grid);
    cache.keep(c, one_brick());
    EXPECT_EQ(cache.find(b), nullptr);
    EXPECT_NE(cache.find(a), nullptr);
    EXPECT_NE(cache.find(c), nullptr);
    EXPECT_EQ(cache.bytes(), 2 * one);
}

TEST(InstantCache, WhatIsTooLargeIsNotKept) {
    InstantCache cache(4096);
    cache.keep({}, one_brick());
    EXPECT_EQ(cache.find({}), nullptr);
    EXPECT_EQ(cache.bytes(), 0U);
}

}  // namespace
}  // namespace stormcellar::pipeline
