#include "stormcellar/grid/grid_spec.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

GridSpec small() {
    GridSpec spec = default_spec(35.3, -97.3);
    spec.nx = 4;
    spec.ny = 3;
    spec.levels_m = {500, 1000};
    return spec;
}

TEST(GridSpec, DefaultIs460KilometresBy32Levels) {
    const GridSpec spec = default_spec(35.3, -97.3);
    EXPECT_TRUE(validate(spec));
    EXPECT_EQ(spec.nx, 460);
    EXPECT_EQ(spec.ny, 460);
    EXPECT_EQ(spec.nz(), 32);
    EXPECT_EQ(spec.levels_m.front(), 500);
    EXPECT_EQ(spec.levels_m.back(), 16000);
    EXPECT_EQ(spec.x_m(0), -229500);
    EXPECT_EQ(spec.y_m(459), 229500);
}

TEST(GridSpec, CellsLieSymmetricallyAboutTheCentre) {
    GridSpec spec = small();
    for (const int n : {1, 2, 5, 512}) {
        spec.nx = n;
        for (int ix = 0; ix < n; ++ix)
            EXPECT_EQ(spec.x_m(ix), -spec.x_m(n - 1 - ix));
    }
    spec.nx = 512;
    EXPECT_EQ(spec.x_m(0), -255500);
}

TEST(GridSpec, IndexRunsUpTheColumnFirst) {
    const GridSpec spec = small();
    EXPECT_EQ(spec.index(0, 0, 1), 1U);
    EXPECT_EQ(spec.index(1, 0, 0), 2U);
    EXPECT_EQ(spec.index(0, 1, 0), 8U);
    EXPECT_EQ(spec.index(3, 2, 1) + 1, spec.cell_count());
}

TEST(GridSpec, NonsenseIsABadArgument) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [](auto change) {
        GridSpec spec = small();
        change(spec);
        const Status status = validate(spec);
        return !status && status.error().code == ErrorCode::bad_argument;
    };
    EXPECT_TRUE(validate(small()));
    EXPECT_TRUE(refused([](GridSpec& s) { s.nx = 0; }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.ny = 16385; }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.spacing_m = 0; }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.spacing_m = HUGE_VAL; }));
    EXPECT_TRUE(refused([&](GridSpec& s) { s.spacing_m = nan; }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.center_latitude_deg = 90.1; }));
    EXPECT_TRUE(refused([&](GridSpec& s) { s.center_longitude_deg = nan; }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.levels_m.clear(); }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.levels_m = {500, 500}; }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.levels_m = {1000, 500}; }));
    EXPECT_TRUE(refused([&](GridSpec& s) { s.levels_m = {nan}; }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.levels_m = {60001}; }));
    EXPECT_TRUE(refused([](GridSpec& s) { s.levels_m = {-1001}; }));
    EXPECT_TRUE(refused([](GridSpec& s) {
        s.levels_m.clear();
        for (int i = 0; i < 1025; ++i)
            s.levels_m.push_back(i);
    }));
}

}  // namespace
}  // namespace stormcellar::grid
