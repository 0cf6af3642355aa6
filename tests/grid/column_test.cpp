// The status rule case by case (DESIGN section 5, docs/geometry.md).
#include "grid/column.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

const Sample unseen{};
const Sample folded{CellStatus::range_folded, 0, 0};
Sample valued(float value) {
    return {CellStatus::value, value, 0};
}
Sample quiet(float limit_dbz) {
    return {CellStatus::no_echo, 0, limit_dbz};
}
CellResult mix(const Sample& a, const Sample& b, float weight_b,
               Blending blending = Blending::with_detection_limit) {
    return blend(a, b, weight_b, blending);
}

TEST(Blend, TwoValuesAreLinear) {
    const CellResult cell = mix(valued(10), valued(30), 0.25F);
    EXPECT_EQ(cell.status, CellStatus::value);
    EXPECT_FLOAT_EQ(cell.value, 15);
}

TEST(Blend, ValueAndNoEcho) {
    EXPECT_EQ(mix(valued(20), quiet(-10), 0.5F).status, CellStatus::value) << "v = n is a value";
    EXPECT_FLOAT_EQ(mix(valued(20), quiet(-10), 0.5F).value, 5);
    EXPECT_FLOAT_EQ(mix(valued(20), quiet(-10), 0.25F).value, 12.5F);
    EXPECT_EQ(mix(valued(20), quiet(-10), 0.51F).status, CellStatus::no_echo);
    EXPECT_FLOAT_EQ(mix(quiet(-10), valued(20), 0.75F).value, 12.5F);
}

TEST(Blend, NoEchoNeverEntersOtherMoments) {
    EXPECT_FLOAT_EQ(mix(valued(20), quiet(-10), 0.25F, Blending::values_only).value, 20);
    EXPECT_FLOAT_EQ(mix(valued(20), quiet(-10), 0.25F, Blending::nearest).value, 20);
    EXPECT_EQ(mix(valued(20), quiet(-10), 0.6F, Blending::nearest).status, CellStatus::no_echo);
}

TEST(Blend, ValueAndNotSeen) {
    EXPECT_EQ(mix(valued(20), unseen, 0.5F).status, CellStatus::value) << "u is not over one half";
    EXPECT_FLOAT_EQ(mix(valued(20), unseen, 0.4F).value, 20);
    EXPECT_EQ(mix(valued(20), unseen, 0.51F).status, CellStatus::not_seen);
}

TEST(Blend, NoEchoAndNotSeen) {
    EXPECT_EQ(mix(quiet(0), unseen, 0.5F).status, CellStatus::no_echo);
    EXPECT_EQ(mix(quiet(0), unseen, 0.51F).status, CellStatus::not_seen);
}

TEST(Blend, FoldedNeedsTheLargestShare) {
    EXPECT_EQ(mix(folded, valued(20), 0.4F).status, CellStatus::range_folded);
    EXPECT_EQ(mix(folded, valued(20), 0.5F).status, CellStatus::value);
    EXPECT_FLOAT_EQ(mix(folded, valued(20), 0.6F).value, 20) << "folded never enters a value";
    EXPECT_EQ(mix(folded, quiet(0), 0.4F).status, CellStatus::range_folded);
    EXPECT_EQ(mix(folded, quiet(0), 0.5F).status, CellStatus::no_echo);
    EXPECT_EQ(mix(folded, unseen, 0.5F).status, CellStatus::range_folded);
    EXPECT_EQ(mix(folded, unseen, 0.51F).status, CellStatus::not_seen);
}

TEST(Blend, EqualStatesStay) {
    for (const float weight : {0.0F, 0.3F, 0.5F, 1.0F}) {
        EXPECT_EQ(mix(unseen, unseen, weight).status, CellStatus::not_seen);
        EXPECT_EQ(mix(folded, folded, weight).status, CellStatus::range_folded);
        EXPECT_EQ(mix(quiet(0), quiet(5), weight).status, CellStatus::no_echo);
    }
}

TEST(Blend, VelocitiesAreNeverAveraged) {
    EXPECT_EQ(mix(valued(-25), valued(25), 0.4F, Blending::nearest).value, -25);
    EXPECT_EQ(mix(valued(-25), valued(25), 0.6F, Blending::nearest).value, 25);
}

TEST(BlendingOf, EachMoment) {
    EXPECT_EQ(blending_of(level2::Moment::ref), Blending::with_detection_limit);
    EXPECT_EQ(blending_of(level2::Moment::vel), Blending::nearest);
    EXPECT_EQ(blending_of(level2::Moment::phi), Blending::nearest);
    EXPECT_EQ(blending_of(level2::Moment::rho), Blending::values_only);
}

struct Filled {
    std::vector<CellStatus> status;
    std::vector<float> values;
};
Filled fill(const std::vector<BeamSample>& beams, const std::vector<float>& levels_m) {
    Filled column{std::vector<CellStatus>(levels_m.size()), std::vector<float>(levels_m.size())};
    fill_column(beams, levels_m, Blending::with_detection_limit, column.status, column.values);
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
    EXPECT_FLOAT_EQ(column.values[3], 10) << "within the lowest beam: its sample";
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

}  // namespace
}  // namespace stormcellar::grid
