// Tests that echo arrives where a known motion brings it, and that unseen places stay unseen.
#include "grid/mosaic/extrapolation.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/grid/moving_blobs.h"
#include "tests/grid/square_spec.h"

namespace stormcellar::grid {
namespace {

constexpr double later_s = 1800;
constexpr double half_column_db = 0.6;  // as in grid/mosaic/extrapolation.h

GridSpec nowcast_spec() {
    GridSpec spec = square_spec(35, -97, 100);
    spec.levels_m = {1000, 2000, 4000};
    return spec;
}

// Returns two storms that do not touch, because the reflectivity has a kink where echoes touch.
BrickGrid echo_at(double t_s, double east_mps, double north_mps, double seen_km = 1e9) {
    const std::vector<Blob> blobs = {{-20, -15, 12, 55, east_mps, north_mps},
                                     {18, 14, 7, 38, east_mps, north_mps}};
    return BrickGrid::from(blob_grid(nowcast_spec(), blobs, t_s, seen_km),
                           default_quantization(level2::Moment::ref));
}

std::uint16_t code_at_cell(const BrickGrid& grid, int ix, int iy, int iz) {
    const BrickView view = grid.view();
    return view.status(ix, iy, iz) == CellStatus::value
               ? view.code_at(view.offset_x(ix) + view.offset_y(iy) + view.offset_z(iz))
               : static_cast<std::uint16_t>(view.status(ix, iy, iz));
}

TEST(Extrapolation, ByWholeColumnsGivesTheCodesOfTheMovedGrid) {
    // 10 columns to the east and 5 to the south.
    const MotionField motion({static_cast<float>(10 / later_s), static_cast<float>(-5 / later_s)});
    const BrickGrid now = echo_at(0, 0, 0, 45);
    const auto later = extrapolate(now.view(), motion, later_s, 2);
    ASSERT_TRUE(later) << later.error().message;
    for (int ix = 0; ix < 100; ++ix) {
        for (int iy = 0; iy < 100; ++iy) {
            const bool comes_from_the_grid = ix >= 10 && iy < 95;
            const auto expected = comes_from_the_grid
                                      ? code_at_cell(now, ix - 10, iy + 5, 1)
                                      : static_cast<std::uint16_t>(CellStatus::not_seen);
            ASSERT_EQ(code_at_cell(*later, ix, iy, 1), expected) << ix << ", " << iy;
        }
    }
}

TEST(Extrapolation, ByHalfAColumnErrsByLessThanStated) {
    // 12.5 columns to the east and 3.5 to the north. The small storm curves by 20 / 7^2 dB per
    // square column along each axis, or 0.8 in all; in the middle of four columns, a bilinear mean
    // then errs by an eighth of that. The codes round by 0.25 dB each.
    const double east_mps = 12'500 / later_s, north_mps = 3'500 / later_s;
    const BrickGrid now = echo_at(0, east_mps, north_mps);
    const BrickGrid truth = echo_at(later_s, east_mps, north_mps);
    const MotionField motion(
        {static_cast<float>(east_mps / 1000), static_cast<float>(north_mps / 1000)});
    const auto later = extrapolate(now.view(), motion, later_s);
    ASSERT_TRUE(later);
    int compared = 0;
    for (int ix = 14; ix < 100; ++ix) {
        for (int iy = 5; iy < 100; ++iy) {
            if (truth.view().status(ix, iy, 0) != CellStatus::value) continue;
            const float dbz = truth.view().value(ix, iy, 0);
            if (dbz < 3) continue;  // edge of the echo: the mean includes cells without echo
            ASSERT_EQ(later->view().status(ix, iy, 0), CellStatus::value) << ix << ", " << iy;
            EXPECT_NEAR(later->view().value(ix, iy, 0), dbz, half_column_db) << ix << ", " << iy;
            ++compared;
        }
    }
    EXPECT_GT(compared, 500);
}

TEST(Extrapolation, FollowsACurve) {
    // A solid rotation about column (50, 50), by a quarter of a turn in an hour.
    const float rate = static_cast<float>(std::acos(-1.0) / 2 / 3600);
    const MotionField turn(2, 2, 100,
                           {{50 * rate, -50 * rate},
                            {50 * rate, 50 * rate},
                            {-50 * rate, -50 * rate},
                            {-50 * rate, 50 * rate}},
                           {});
    Grid grid = blob_grid(nowcast_spec(), {}, 0);
    for (const int ix : {74, 75, 76}) {
        for (const int iy : {49, 50, 51}) {
            grid.status[grid.spec.index(ix, iy, 0)] = CellStatus::value;
            grid.values[grid.spec.index(ix, iy, 0)] = 40;
        }
    }
    const auto now = BrickGrid::from(grid, default_quantization(level2::Moment::ref));
    const auto later = extrapolate(now.view(), turn, 3600);
    ASSERT_TRUE(later);
    // A point 25 columns east of the center turns to 25 columns north of it. One step of an hour
    // would miss that place by 10 columns.
    ASSERT_EQ(later->view().status(50, 75, 0), CellStatus::value);
    EXPECT_NEAR(later->view().value(50, 75, 0), 40, 0.5);
    EXPECT_EQ(later->view().status(75, 50, 0), CellStatus::no_echo);
}

TEST(Extrapolation, KeepsPlacesUnseenThatWereNotSeen) {
    const BrickGrid now = echo_at(0, 0, 0, 30);
    const auto later = extrapolate(now.view(), MotionField({0.01F, 0}), later_s);
    ASSERT_TRUE(later);
    // The seen circle has moved 18 columns to the east.
    EXPECT_EQ(later->view().status(25, 50, 0), CellStatus::not_seen);
    EXPECT_NE(later->view().status(92, 50, 0), CellStatus::not_seen);
    EXPECT_EQ(later->view().status(99, 50, 0), CellStatus::not_seen);
    EXPECT_EQ(code_at_cell(*later, 50, 3, 0), 0);
}

TEST(Extrapolation, ByNoTimeIsTheGridAndByNegativeTimeAnError) {
    const BrickGrid now = echo_at(0, 0, 0, 40);
    const auto same = extrapolate(now.view(), MotionField({0.02F, -0.01F}), 0);
    ASSERT_TRUE(same);
    for (int ix = 0; ix < 100; ix += 3) {
        for (int iy = 0; iy < 100; iy += 3)
            ASSERT_EQ(code_at_cell(*same, ix, iy, 2), code_at_cell(now, ix, iy, 2));
    }
    const MotionField still({0, 0});
    EXPECT_EQ(extrapolate(now.view(), still, -1).error().code, ErrorCode::bad_argument);
    EXPECT_EQ(extrapolate(now.view(), still, std::numeric_limits<double>::infinity()).error().code,
              ErrorCode::bad_argument);
    EXPECT_EQ(extrapolate(now.view(), still, std::nan("")).error().code, ErrorCode::bad_argument);
}

TEST(Extrapolation, IsTheSameForAnyNumberOfThreads) {
    const BrickGrid now = echo_at(0, 0, 0, 45);
    const MotionField motion(2, 2, 90, {{0.01F, 0}, {0, 0.01F}, {-0.01F, 0.003F}, {0, 0}}, {});
    const auto alone = extrapolate(now.view(), motion, later_s, 1);
    const auto together = extrapolate(now.view(), motion, later_s, 5);
    ASSERT_TRUE(alone && together);
    for (int ix = 0; ix < 100; ++ix) {
        for (int iy = 0; iy < 100; ++iy)
            ASSERT_EQ(code_at_cell(*alone, ix, iy, 1), code_at_cell(*together, ix, iy, 1));
    }
}

TEST(MedianMotion, LeavesOutAFieldThatDiffers) {
    const std::vector<MotionField> fields = {MotionField({1, 2}), MotionField({40, -40}),
                                             MotionField({1.5F, 2.5F})};
    const MotionField median = median_motion(fields, nowcast_spec());
    EXPECT_EQ(median.at(33, 77), (CellMotion{1.5F, 2}));
    EXPECT_EQ(median.whole(), (CellMotion{1.5F, 2}));
    const MotionField of_two = median_motion(std::span(fields).subspan(0, 2), nowcast_spec());
    EXPECT_EQ(of_two.at(0, 0), (CellMotion{20.5F, -19}));
}

}  // namespace
}  // namespace stormcellar::grid
