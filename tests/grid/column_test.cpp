// Tests how a column is filled from one sample of each sweep (grid/fill/column.h).
#include "grid/fill/column.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

const Sample unseen{};
Sample valued(float value) {
    return {CellStatus::value, value, 0, 0};
}
Sample quiet(float limit_dbz) {
    return {CellStatus::no_echo, 0, limit_dbz, 0};
}

struct Filled {
    std::vector<CellStatus> status;
    std::vector<float> values;
};
Filled fill(const std::vector<BeamSample>& beams, const std::vector<float>& levels_m,
            Interpolation interpolation = Interpolation::linear) {
    Filled column{std::vector<CellStatus>(levels_m.size()), std::vector<float>(levels_m.size())};
    fill_column(beams, LevelTable(levels_m), Blending::with_detection_limit, interpolation,
                column.status, column.values);
    return column;
}
BeamSample beam(Sample sample, float height_m, float half_width_m = 100, bool adjacent = true) {
    return {sample, height_m, height_m - half_width_m, height_m + half_width_m, adjacent};
}
constexpr auto no = CellStatus::not_seen;
constexpr auto val = CellStatus::value;

TEST(FillColumn, BeyondTheBeamsItIsNotSeen) {
    const Filled column = fill({beam(valued(10), 1000), beam(valued(20), 2000)},
                               {800, 899, 900, 950, 1000, 1500, 2000, 2050, 2100, 2101});
    EXPECT_EQ(column.status,
              (std::vector<CellStatus>{no, no, val, val, val, val, val, val, val, no}));
    EXPECT_FLOAT_EQ(column.values[3], 10) << "within the edges of the lowest beam";
    EXPECT_FLOAT_EQ(column.values[5], 15);
    EXPECT_FLOAT_EQ(column.values[8], 20);
}

TEST(FillColumn, ALostCutLeavesNotSeenBeyondHalfABeam) {
    const Filled column = fill({beam(valued(10), 1000, 100, false), beam(valued(20), 2000)},
                               {1000, 1100, 1101, 1500, 1899, 1900, 2000});
    EXPECT_EQ(column.status, (std::vector<CellStatus>{val, val, no, no, no, val, val}));
    EXPECT_FLOAT_EQ(column.values[1], 10);
    EXPECT_FLOAT_EQ(column.values[5], 20);
}

TEST(FillColumn, WhereBeamsBesideALostCutOverlapTheNearerCounts) {
    const Filled column =
        fill({beam(valued(10), 1000, 900, false), beam(valued(20), 2000, 900)}, {1400, 1600});
    EXPECT_FLOAT_EQ(column.values[0], 10);
    EXPECT_FLOAT_EQ(column.values[1], 20);
}

// Regression of 2026-11-21: no cell was filled if the lower edge of the lowest beam had no height.
TEST(FillColumn, ALowerEdgeThatIsNowhereLeavesTheRest) {
    BeamSample lowest = beam(valued(10), 1000);
    lowest.lower_edge_m = 1e9F;
    const Filled column = fill({lowest, beam(valued(20), 2000)}, {950, 1000, 1500, 2050});
    EXPECT_EQ(column.status, (std::vector<CellStatus>{no, val, val, val}));
}

TEST(FillColumn, OneSweepIsAsThickAsItsBeam) {
    const Filled column = fill({beam(valued(10), 1000)}, {899, 900, 1000, 1100, 1101});
    EXPECT_EQ(column.status, (std::vector<CellStatus>{no, val, val, val, no}));
}

TEST(FillColumn, EqualHeightsNeverDivideByZero) {
    const Filled column = fill({beam(valued(10), 1000), beam(valued(20), 1000),
                                beam(valued(30), 1000), beam(valued(40), 2000)},
                               {950, 1000, 1500});
    EXPECT_FLOAT_EQ(column.values[0], 10);
    EXPECT_FLOAT_EQ(column.values[1], 30);
    EXPECT_FLOAT_EQ(column.values[2], 35);
    const Filled at_antenna = fill({beam(unseen, 390, 0), beam(unseen, 390, 0)}, {390, 500});
    EXPECT_EQ(at_antenna.status, (std::vector<CellStatus>{no, no}));
}

TEST(FillColumn, ManyLevelsBetweenTwoBeamsThatAgree) {
    const Filled column = fill({beam(quiet(0), 1000), beam(quiet(0), 5000), beam(valued(30), 6000)},
                               {500, 1500, 2500, 3500, 4500, 5000, 5499, 5500, 6000});
    constexpr auto none = CellStatus::no_echo;
    EXPECT_EQ(column.status,
              (std::vector<CellStatus>{no, none, none, none, none, none, none, val, val}));
}

TEST(FillColumn, NearestTakesTheNearerBeam) {
    const Filled column = fill({beam(valued(10), 1000), beam(valued(20), 2000)},
                               {950, 1000, 1499, 1500, 1501, 2000}, Interpolation::nearest);
    EXPECT_EQ(column.values, (std::vector<float>{10, 10, 10, 10, 20, 20}));
    const Filled mixed =
        fill({beam(valued(10), 1000), beam(quiet(0), 2000)}, {1499, 1501}, Interpolation::nearest);
    EXPECT_EQ(mixed.status, (std::vector<CellStatus>{val, CellStatus::no_echo}));
}

}  // namespace
}  // namespace stormcellar::grid
