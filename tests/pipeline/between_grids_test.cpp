// Makes mosaics (frames) of instants between grids, and compares them with synthetic echoes that
// are known at any instant.
#include "pipeline/mosaic/between_grids.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/mosaic/mosaic_maker.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/level2/decode.h"
#include "tests/grid/moving_blobs.h"
#include "tests/pipeline/small_domain.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr UtcTime noon{std::chrono::sys_days{std::chrono::year{2024} / 6 / 1} +
                       std::chrono::hours{12}};
constexpr auto moment = level2::Moment::ref;

// Echo that moves east at 20 m/s and north at 10 m/s.
const std::vector<grid::Blob> storm = {{-30, -20, 15, 50, 20, 10}, {25, 10, 12, 45, 20, 10}};

grid::GridSpec small_spec() {
    grid::GridSpec spec = grid::default_spec(35, -97);
    spec.nx = spec.ny = 120;
    spec.levels_m = {1000, 2000, 4000};
    return spec;
}

class BetweenGridsTest : public ::testing::Test {
  protected:
    // Commits the scene `seconds` after noon, as if seen in an instant.
    void commit(double seconds, double seen_km = 1e9) {
        grid::Grid grid = grid::blob_grid(small_spec(), storm, seconds, seen_km);
        grid.time = grid.start_time = grid.end_time = at(seconds);
        grid.sites = {{"KTLX", 35, -97, 300}};
        const auto bricks = grid::BrickGrid::from(grid, grid::default_quantization(moment));
        ASSERT_TRUE(store_.commit("KTLX", cache::describe(grid), bricks.view()));
    }
    static UtcTime at(double seconds) {
        return noon + std::chrono::milliseconds{std::llround(seconds * 1000)};
    }
    [[nodiscard]] BetweenGrids open(BetweenOptions options = {}) {
        auto between = BetweenGrids::open(store_, "KTLX", moment, options, problems_);
        EXPECT_TRUE(between) << between.error().message;
        return std::move(*between);
    }
    static grid::Grid made(BetweenGrids& between, double seconds) {
        auto frame = between.at(at(seconds));
        EXPECT_TRUE(frame) << frame.error().message;
        EXPECT_TRUE(*frame);
        EXPECT_EQ((*frame)->description.time, at(seconds));
        return grid::to_dense((*frame)->mosaic.cells.view());
    }
    // Returns the RMS error in dB where the scene at that time has more than 5 dBZ; a cell without
    // a value counts as 0 dBZ.
    static double rms_error(const grid::Grid& grid, double seconds) {
        const grid::Grid truth = grid::blob_grid(small_spec(), storm, seconds);
        double sum = 0;
        int count = 0;
        for (std::size_t cell = 0; cell < truth.values.size(); ++cell) {
            if (truth.status[cell] != grid::CellStatus::value || truth.values[cell] < 5) continue;
            const bool valued = grid.status[cell] == grid::CellStatus::value;
            const double value = valued ? static_cast<double>(grid.values[cell]) : 0;
            sum += (value - static_cast<double>(truth.values[cell])) *
                   (value - static_cast<double>(truth.values[cell]));
            ++count;
        }
        EXPECT_GT(count, 300);
        return std::sqrt(sum / count);
    }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    std::vector<std::string> problems_;
};

TEST_F(BetweenGridsTest, AtAGridsOwnTimeItIsThatGrid) {
    commit(0);
    commit(300);
    for (const auto method :
         {grid::TimeMethod::nearest, grid::TimeMethod::blend, grid::TimeMethod::advected}) {
        BetweenGrids between = open({method, {}, {}, 2});
        for (const double seconds : {0.0, 300.0}) {
            const auto path = store_.path_of("KTLX", moment, at(seconds));
            const auto stored = cache::GridFile::open(*path);
            const grid::Grid grid = made(between, seconds), own = grid::to_dense(stored->view());
            EXPECT_EQ(grid.status, own.status);
            EXPECT_EQ(grid.values, own.values);
        }
    }
}

TEST_F(BetweenGridsTest, HalfWayTheEchoIsHalfWay) {
    commit(0);
    commit(300);
    BetweenGrids advected = open();
    BetweenGrids blend = open({grid::TimeMethod::blend, {}, {}, 1});
    BetweenGrids nearest = open({grid::TimeMethod::nearest, {}, {}, 1});
    const double moved = rms_error(made(advected, 150), 150);
    EXPECT_LT(moved, 1);  // the field falls by 0.7 dB or more in a kilometer
    EXPECT_LT(moved, 0.6 * rms_error(made(blend, 150), 150));
    EXPECT_LT(moved, 0.4 * rms_error(made(nearest, 150), 150));
    EXPECT_LT(rms_error(made(advected, 60), 60), 1);  // uses the motion of the same pair
}

TEST_F(BetweenGridsTest, WhatOneEndHasNotSeenIsTheOthers) {
    commit(0, 40);
    commit(300);
    BetweenGrids blend = open({grid::TimeMethod::blend, {}, {}, 1});
    const grid::Grid middle = made(blend, 150);
    const grid::Grid late =
        grid::to_dense(cache::GridFile::open(*store_.path_of("KTLX", moment, at(300)))->view());
    const grid::GridSpec spec = small_spec();
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            if (std::hypot(spec.x_m(ix), spec.y_m(iy)) < 41'000) continue;
            const std::size_t cell = spec.index(ix, iy, 1);
            ASSERT_EQ(middle.status[cell], late.status[cell]);
            if (late.status[cell] == grid::CellStatus::value) {
                ASSERT_EQ(middle.values[cell], late.values[cell]);
            }
        }
    }
}

TEST_F(BetweenGridsTest, WhatNeitherHasSeenIsNotSeen) {
    commit(0, 40);
    commit(300, 40);
    BetweenGrids between = open();
    const grid::Grid middle = made(between, 150);
    EXPECT_EQ(middle.status[small_spec().index(1, 1, 1)], grid::CellStatus::not_seen);
}

TEST_F(BetweenGridsTest, FramesStandAtWholeIntervalsAndBridgeNoLongGap) {
    commit(30);
    commit(330);
    commit(330 + 31 * 60);
    commit(630 + 31 * 60);
    BetweenGrids between = open();
    const auto instants = between.instants(std::chrono::seconds{60});
    ASSERT_THAT(instants, SizeIs(10));
    EXPECT_EQ(instants.front(), at(60));
    EXPECT_EQ(instants[4], at(300));
    EXPECT_EQ(instants[5], at(360 + 31 * 60));
    EXPECT_FALSE(*between.at(at(900)));
    EXPECT_FALSE(*between.at(at(0)));
    EXPECT_FALSE(*between.at(at(4000)));
}

TEST_F(BetweenGridsTest, TheRangeIsKept) {
    for (const double seconds : {0.0, 300.0, 600.0, 900.0})
        commit(seconds);
    BetweenGrids between = open({grid::TimeMethod::advected, at(420), at(660), 1});
    const auto instants = between.instants(std::chrono::seconds{60});
    ASSERT_THAT(instants, SizeIs(5));
    EXPECT_EQ(instants.front(), at(420));
    EXPECT_EQ(instants.back(), at(660));
    EXPECT_LT(rms_error(made(between, 660), 660), 1);
}

TEST_F(BetweenGridsTest, SaysWhatItDoesAndWhatIsNotKnown) {
    commit(0);
    EXPECT_EQ(open().method_text(), "advected, each volume as of its middle");
    EXPECT_EQ(open({grid::TimeMethod::nearest, {}, {}, 1}).method_text(), "nearest");
    const auto none = BetweenGrids::open(store_, "KFDR", moment, {}, problems_);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::not_found);
}

TEST_F(BetweenGridsTest, AGridThatDoesNotVerifyIsAnErrorOfItsFrames) {
    commit(0);
    commit(300);
    BetweenGrids between = open();
    fs::resize_file(*store_.path_of("KTLX", moment, at(300)), 1000);
    EXPECT_FALSE(between.at(at(150)));
    std::vector<std::string> problems;
    ASSERT_TRUE(BetweenGrids::open(store_, "KTLX", moment, {}, problems));
    EXPECT_THAT(problems, SizeIs(1));
}

// Tests frames between the frames of a domain that MosaicMaker keeps up to date.
class BetweenMosaics : public ::testing::Test {
  protected:
    void SetUp() override { STORMCELLAR_NEED_DATA(); }
    static Domain domain() {
        Domain domain = small_domain();
        domain.spec.levels_m = {1000, 3000};
        return domain;
    }
    void fill(const Domain& domain) {
        MosaicMaker keeper(&store_, {domain});
        for (const char* name : {"KBGM20050822_024414.gz", "KBGM20050822_025001.gz"}) {
            level2::DecodeOptions options;
            options.fallback_station = "KBGM";
            auto decoded =
                level2::decode(*read_file(testing::real_file("sequence-kbgm") / name), options);
            ASSERT_TRUE(decoded);
            const auto antenna = level2::antenna_position(decoded->volume);
            const grid::SitePosition site{"KBGM", antenna->latitude_deg, antenna->longitude_deg,
                                          antenna->altitude_m};
            ASSERT_TRUE(keeper.take_in({decoded->volume, site, name}, 2));
        }
    }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    std::vector<std::string> problems_;
};

TEST_F(BetweenMosaics, AtAFramesInstantItIsThatFrame) {
    fill(domain());
    const auto frames = *store_.list("north", moment, {}, {});
    ASSERT_THAT(frames, SizeIs(1));
    auto between = BetweenGrids::open(store_, "north", moment, {}, problems_);
    ASSERT_TRUE(between) << between.error().message;
    EXPECT_TRUE(between->stands(frames[0].path));
    const auto made = between->at(frames[0].time);
    ASSERT_TRUE(made && *made);
    const auto stored = cache::GridFile::open(frames[0].path);
    const grid::BrickView ours = (*made)->mosaic.cells.view(), theirs = stored->view();
    EXPECT_TRUE(
        std::equal(ours.codes.begin(), ours.codes.end(), theirs.codes.begin(), theirs.codes.end()));
    EXPECT_THAT(between->instants(std::chrono::seconds{60}), SizeIs(1));

    auto nearest = BetweenGrids::open(store_, "north", moment,
                                      {grid::TimeMethod::nearest, {}, {}, 1}, problems_);
    EXPECT_FALSE(nearest->stands(frames[0].path));
}

TEST_F(BetweenMosaics, NothingIsMadeByOtherRulesThanTheDomains) {
    Domain other = domain();
    other.overlap_length_m = 100'000;
    fill(other);
    const auto between = BetweenGrids::open(store_, "north", moment, {}, problems_);
    ASSERT_FALSE(between);
    EXPECT_EQ(between.error().code, ErrorCode::unsupported);
}

TEST_F(BetweenMosaics, WithoutTheSitesGridsThereIsNothingBetween) {
    fill(domain());
    const auto partials = store_.list("north.KBGM", moment, {}, {});
    for (const cache::StoreEntry& entry : *partials)
        ASSERT_TRUE(store_.remove(entry));
    fs::remove_all(directory_ / "cache" / "north.KBGM");
    const auto between = BetweenGrids::open(store_, "north", moment, {}, problems_);
    ASSERT_FALSE(between);
    EXPECT_THAT(between.error().message, HasSubstr("does not have the grids of north's sites"));
}

}  // namespace
}  // namespace stormcellar::pipeline
