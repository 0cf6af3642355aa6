#include "retrieve/dealias/regions.h"

#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

VelocitySheet sheet_of(int radials, int gates, std::vector<float> turns, bool is_circle = false) {
    VelocitySheet sheet;
    sheet.radials = radials;
    sheet.gates = gates;
    sheet.turns = std::move(turns);
    sheet.turn_mps = 40;
    sheet.is_circle = is_circle;
    sheet.azimuths_deg.assign(static_cast<std::size_t>(radials), 0);
    return sheet;
}

TEST(Regions, AreGatesOfOneThirdSideBySide) {
    const SheetRegions found = find_regions(sheet_of(2, 4,
                                                     {0.4F, 0.4F, -0.4F, none,  //
                                                      0.3F, 0.0F, -0.3F, -0.3F}));
    EXPECT_EQ(found.runs.size(), 5U);
    EXPECT_EQ(found.gate_count, (std::vector<std::int32_t>{3, 3, 1}));
}

// The jump from 0.45 to -0.45 turns becomes 0.1 turns upward if the second gate has one fold more.
TEST(Regions, AJumpVotesForAFold) {
    const SheetRegions found = find_regions(sheet_of(1, 2, {0.45F, -0.45F}));
    ASSERT_EQ(found.edges.size(), 1U);
    EXPECT_EQ(found.edges[0].votes.winner(), 1);
    EXPECT_NEAR(found.edges[0].votes.at(1), 0.82, 1e-5);
    EXPECT_EQ(found.jumps, 1);
    EXPECT_EQ(found.pairs, 1);
}

TEST(Regions, AGapWeakensAVote) {
    const SheetRegions found = find_regions(sheet_of(1, 4, {0.3F, none, none, -0.3F}));
    ASSERT_EQ(found.edges.size(), 1U);
    EXPECT_NEAR(found.edges[0].votes.total(), (1 - 1.8 * 0.4) / 3, 1e-5);
    EXPECT_EQ(found.pairs, 0);
}

TEST(Regions, ACircleIsClosed) {
    const std::vector<float> turns{0.4F, none, none, none, -0.4F};
    EXPECT_EQ(find_regions(sheet_of(5, 1, turns)).edges.size(), 1U);
    const SheetRegions closed = find_regions(sheet_of(5, 1, turns, true));
    ASSERT_EQ(closed.edges.size(), 2U);
    EXPECT_EQ(closed.pairs, 1);
    EXPECT_EQ(closed.edges[1].votes.winner(), -1) << "from the last radial up to the first";
}

TEST(Regions, PiecesOfASplitRegionVoteForItsFold) {
    const VelocitySheet sheet = sheet_of(16, 32, std::vector<float>(512, 0.1F));
    const SheetRegions whole = find_regions(sheet);
    ASSERT_EQ(whole.gate_count, (std::vector<std::int32_t>{512}));
    EXPECT_EQ(split_regions(sheet, whole, {0}).gate_count, whole.gate_count);

    SheetRegions split = split_regions(sheet, whole, {1});
    EXPECT_EQ(split.gate_count, (std::vector<std::int32_t>{128, 128, 128, 128}));
    EXPECT_EQ(split.pairs, whole.pairs);
    combine_edges(split.edges, 4);
    ASSERT_EQ(split.edges.size(), 4U);
    for (const FoldEdge& edge : split.edges)
        EXPECT_EQ(edge.votes.at(0), edge.b - edge.a == 1 ? 8 : 16) << edge.a << ' ' << edge.b;
}

}  // namespace
}  // namespace stormcellar::retrieve
