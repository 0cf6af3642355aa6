// Tests that the estimate from two grids recovers a known motion.
#include "grid/mosaic/motion.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "grid/mosaic/echo_image.h"
#include "tests/grid/moving_blobs.h"
#include "tests/grid/square_spec.h"

namespace stormcellar::grid {
namespace {

constexpr double accuracy_mps = 1.5;  // as in grid/mosaic/motion.h
constexpr double apart_s = 300;

GridSpec drift_spec(int cells, double spacing_m) {
    GridSpec spec = square_spec(35, -97, cells, spacing_m);
    spec.levels_m = {1000, 2000, 4000};
    return spec;
}

// Returns fifteen different storms all over the grid.
std::vector<Blob> storms(double east_mps, double north_mps) {
    std::vector<Blob> blobs;
    for (int i = 0; i < 15; ++i) {
        const double angle = 2.4 * i, distance = 14.0 * i;
        blobs.push_back({distance * std::cos(angle), distance * std::sin(angle), 6.0 + (i * 7) % 11,
                         35.0 + (i * 5) % 23, east_mps, north_mps});
    }
    return blobs;
}

Result<std::optional<MotionField>> between(const GridSpec& spec, const std::vector<Blob>& blobs,
                                           const MotionOptions& options = {}) {
    const auto quantization = default_quantization(level2::Moment::ref);
    const auto before = BrickGrid::from(blob_grid(spec, blobs, 0), quantization);
    const auto after = BrickGrid::from(blob_grid(spec, blobs, apart_s), quantization);
    return estimate_motion(before.view(), after.view(), apart_s, options);
}

struct Drift {
    double east_mps, north_mps;
};

class EveryDrift : public ::testing::TestWithParam<Drift> {};

TEST_P(EveryDrift, IsRecoveredEverywhere) {
    const GridSpec spec = drift_spec(400, 1000);
    const auto [east_mps, north_mps] = GetParam();
    const auto field = between(spec, storms(east_mps, north_mps));
    ASSERT_TRUE(field) << field.error().message;
    ASSERT_TRUE(*field);
    for (int iy = 0; iy < spec.ny; iy += 40) {
        for (int ix = 0; ix < spec.nx; ix += 40) {
            const CellMotion motion = (*field)->at(ix, iy);
            EXPECT_NEAR(static_cast<double>(motion.x) * spec.spacing_m, east_mps, accuracy_mps)
                << ix << ", " << iy;
            EXPECT_NEAR(static_cast<double>(motion.y) * spec.spacing_m, north_mps, accuracy_mps)
                << ix << ", " << iy;
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Motion, EveryDrift,
                         ::testing::Values(Drift{0, 0}, Drift{20, 0}, Drift{0, -20}, Drift{14, 11},
                                           Drift{-33, 21}, Drift{5, -3}, Drift{-2, 48}));

TEST(Motion, DiffersBetweenTwoRegions) {
    const GridSpec spec = drift_spec(400, 1000);
    std::vector<Blob> blobs;
    for (int i = 0; i < 8; ++i) {
        const double y_km = -160 + 45.0 * i;
        blobs.push_back({-120.0 + 3 * i, y_km, 7.0 + i, 50, 12, 4});
        blobs.push_back({120.0 - 4 * i, y_km, 9.0 + i, 45, 4, 12});
    }
    const auto field = between(spec, blobs);
    ASSERT_TRUE(field && *field);
    const CellMotion west = (*field)->at(80, 200), east = (*field)->at(320, 200);
    EXPECT_NEAR(static_cast<double>(west.x) * 1000, 12, 1.5);
    EXPECT_NEAR(static_cast<double>(west.y) * 1000, 4, 1.5);
    EXPECT_NEAR(static_cast<double>(east.x) * 1000, 4, 1.5);
    EXPECT_NEAR(static_cast<double>(east.y) * 1000, 12, 1.5);
}

TEST(Motion, IsNotKnownWhereThereIsNoEchoOrHardlyAny) {
    const GridSpec spec = drift_spec(300, 1000);
    const auto none = between(spec, {});
    ASSERT_TRUE(none);
    EXPECT_FALSE(*none);
    const auto little = between(spec, {{0, 0, 3, 30, 10, 0}});
    ASSERT_TRUE(little);
    EXPECT_FALSE(*little);
}

TEST(Motion, HasTheSameBitsOnAnyNumberOfThreads) {
    const GridSpec spec = drift_spec(300, 1000);
    MotionOptions options;
    const auto alone = between(spec, storms(11, -7), options);
    options.threads = 5;
    const auto together = between(spec, storms(11, -7), options);
    ASSERT_TRUE(alone && *alone && together && *together);
    for (int at = 0; at < 300; at += 7)
        EXPECT_EQ((*alone)->at(at, 300 - at), (*together)->at(at, 300 - at));
}

TEST(Motion, RefusesDifferentSpecsAndInvalidTimes) {
    const auto quantization = default_quantization(level2::Moment::ref);
    const auto one = BrickGrid::from(blob_grid(drift_spec(100, 1000), {}, 0), quantization);
    const auto other = BrickGrid::from(blob_grid(drift_spec(100, 2000), {}, 0), quantization);
    EXPECT_EQ(estimate_motion(one.view(), other.view(), 300).error().code, ErrorCode::bad_argument);
    EXPECT_EQ(estimate_motion(one.view(), one.view(), 0).error().code, ErrorCode::bad_argument);
    EXPECT_EQ(estimate_motion(one.view(), one.view(), std::nan("")).error().code,
              ErrorCode::bad_argument);
}

TEST(MotionField, IsBilinearBetweenNodesAndConstantBeyond) {
    const MotionField field(2, 2, 10, {{0, 0}, {1, 0}, {0, 2}, {1, 2}}, {5, 5});
    EXPECT_EQ(field.at(0, 0), (CellMotion{0, 0}));
    EXPECT_EQ(field.at(5, 5), (CellMotion{0.5F, 1}));
    EXPECT_EQ(field.at(-50, 90), (CellMotion{0, 2}));
    EXPECT_EQ(field.greatest(), (CellMotion{1, 2}));
    EXPECT_EQ(MotionField({3, 4}).at(7, -7), (CellMotion{3, 4}));
}

TEST(EchoImage, HoldsTheMeanOfColumnMaximaAboveTheFloor) {
    GridSpec spec = drift_spec(4, 1000);
    Grid grid = blob_grid(spec, {}, 0);
    const auto set = [&](int ix, int iy, int iz, float dbz) {
        grid.status[spec.index(ix, iy, iz)] = CellStatus::value;
        grid.values[spec.index(ix, iy, iz)] = dbz;
    };
    set(0, 0, 1, 25);  // 20 dB above the floor
    set(0, 0, 2, 15);
    set(1, 0, 2, 45);  // 40 dB above the floor
    set(2, 0, 0, 60);  // below the lowest level that counts
    set(3, 0, 1, 4);   // below the floor
    const auto bricks = BrickGrid::from(grid, default_quantization(level2::Moment::ref));
    const EchoImage image = echo_image(bricks.view(), {2, 5, 1500});
    ASSERT_EQ(image.width, 2);
    EXPECT_EQ(image.echo_db[0], 15);  // (20 + 40 + 0 + 0) / 4
    EXPECT_EQ(image.echo_db[1], 0);
    EXPECT_EQ(image.seen[3], 1);
    const EchoImage half = halved(image);
    ASSERT_EQ(half.width, 1);
    EXPECT_EQ(half.cells, 4);
    EXPECT_EQ(half.echo_db[0], 15.0F / 4);
}

TEST(EchoImage, APixelIsSeenWhereHalfOfItsColumnsAre) {
    const GridSpec spec = drift_spec(8, 1000);
    Grid grid = blob_grid(spec, {}, 0);
    for (int ix = 0; ix < 8; ++ix) {
        for (int iy = 0; iy < 8; ++iy) {
            for (int iz = 0; iz < 3; ++iz) {
                if (ix > 4) grid.status[spec.index(ix, iy, iz)] = CellStatus::not_seen;
            }
        }
    }
    const auto bricks = BrickGrid::from(grid, default_quantization(level2::Moment::ref));
    const EchoImage image = echo_image(bricks.view(), {2, 5, 1500});
    EXPECT_EQ(image.seen[image.index(1, 1)], 1);
    EXPECT_EQ(image.seen[image.index(2, 1)], 1);  // one of two columns
    EXPECT_EQ(image.seen[image.index(3, 1)], 0);
}

}  // namespace
}  // namespace stormcellar::grid
