// Tests that nowcasts are made only with known motions, and that hindcasts measure their error.
#include "retrieve/nowcast/nowcast.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "retrieve/nowcast/hindcast.h"
#include "retrieve/nowcast/nowcast_note.h"
#include "tests/grid/moving_blobs.h"
#include "tests/grid/square_spec.h"

namespace stormcellar::retrieve {
namespace {

using ::testing::HasSubstr;

constexpr double volume_s = 300;

// A sequence of grids that owns their bricks.
struct Sequence {
    std::vector<grid::BrickGrid> bricks;
    std::vector<TimedGrid> grids;

    void add(const grid::Grid& grid, double t_s) {
        bricks.push_back(
            grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref)));
        times_s.push_back(t_s);
    }
    void finish() {
        for (std::size_t i = 0; i < bricks.size(); ++i) {
            grids.push_back({bricks[i].view(),
                             UtcTime{std::chrono::milliseconds(std::llround(times_s[i] * 1000))}});
        }
    }
    std::vector<double> times_s;
};

grid::GridSpec sequence_spec(double spacing_m = 1000) {
    grid::GridSpec spec = grid::square_spec(35, -97, 300, spacing_m);
    spec.levels_m = {2000, 4000};
    return spec;
}

std::vector<grid::Blob> drifting_storms() {
    std::vector<grid::Blob> blobs;
    for (int i = 0; i < 12; ++i) {
        const double angle = 2.4 * i, distance = 9.0 * i;
        blobs.push_back({distance * std::cos(angle), distance * std::sin(angle), 6.0 + (i * 7) % 9,
                         38.0 + (i * 5) % 19, 15, 8});
    }
    return blobs;
}

// Makes grids of storms that drift without change, one every five minutes.
Sequence drifting(int count, double apart_s = volume_s) {
    Sequence sequence;
    for (int i = 0; i < count; ++i) {
        sequence.add(grid::blob_grid(sequence_spec(), drifting_storms(), i * apart_s), i * apart_s);
    }
    sequence.finish();
    return sequence;
}

std::string refusal_of(const Sequence& sequence) {
    const auto motions = pair_motions(sequence.grids, 1);
    return motions ? "" : motions.error().message;
}

TEST(Nowcast, BringsDriftingStormsWhereTheyWillBe) {
    const Sequence sequence = drifting(4);
    const auto motions = pair_motions(sequence.grids, 2);
    ASSERT_TRUE(motions) << motions.error().message;
    const auto later = nowcast(sequence.grids.back().view, *motions, 30, 2);
    ASSERT_TRUE(later) << later.error().message;
    const grid::Grid truth =
        grid::blob_grid(sequence_spec(), drifting_storms(), 3 * volume_s + 1800);
    // The motion is known within 1.5 m/s (grid/mosaic/motion.h), which is 2.7 km after 30 minutes.
    int heavy = 0, met = 0;
    for (int ix = 3; ix < 297; ++ix) {
        for (int iy = 3; iy < 297; ++iy) {
            const std::size_t cell = truth.spec.index(ix, iy, 0);
            if (truth.values[cell] < 40) continue;
            ++heavy;
            bool is_near = false;
            for (int dx = -3; dx <= 3; ++dx) {
                for (int dy = -3; dy <= 3; ++dy) {
                    const auto view = later->view();
                    is_near =
                        is_near || (view.status(ix + dx, iy + dy, 0) == grid::CellStatus::value &&
                                    view.value(ix + dx, iy + dy, 0) >= 40);
                }
            }
            met += is_near ? 1 : 0;
        }
    }
    EXPECT_GT(heavy, 300);
    EXPECT_EQ(met, heavy);
}

TEST(Nowcast, IsRefusedWhereTheMotionIsUnknown) {
    Sequence sequence;
    for (int i = 0; i < 2; ++i)
        sequence.add(grid::blob_grid(sequence_spec(), {{0, 0, 3, 30, 10, 0}}, i * 300), i * 300);
    sequence.finish();
    const auto motions = pair_motions(sequence.grids, 1);
    ASSERT_TRUE(motions);
    const auto refused = nowcast(sequence.grids.back().view, *motions, 10, 1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::unmet);
    EXPECT_THAT(refused.error().message, HasSubstr("the motion is unknown"));
    EXPECT_FALSE(latest_motion({}, sequence_spec()));
}

TEST(Nowcast, TakesTheMotionsOfTheLastFourPairsThatAreKnown) {
    const grid::MotionField slow({1, 0}), fast({9, 0}), between({3, 1});
    const std::vector<std::optional<grid::MotionField>> pairs = {fast,         fast,    slow,
                                                                 std::nullopt, between, slow};
    const auto motion = latest_motion(pairs, sequence_spec());
    ASSERT_TRUE(motion);
    EXPECT_EQ(motion->at(7, 7), (grid::CellMotion{1, 0}));
}

TEST(Nowcast, NeedsTwoGridsOfTheSameCells) {
    EXPECT_THAT(refusal_of(drifting(1)), HasSubstr("two volumes or more"));
    EXPECT_THAT(refusal_of({}), HasSubstr("two volumes or more"));
    Sequence other = drifting(1);
    other.grids.clear();
    other.add(grid::blob_grid(sequence_spec(2000), {}, 0), 300);
    other.finish();
    EXPECT_THAT(refusal_of(other), HasSubstr("the same area and cells"));
}

TEST(Nowcast, IsRefusedAcrossAGapAndForOneInstant) {
    EXPECT_THAT(refusal_of(drifting(2, 1900)), HasSubstr("gap of 32 minutes"));
    EXPECT_EQ(refusal_of(drifting(2, 600)), "");
    EXPECT_THAT(refusal_of(drifting(2, 0)), HasSubstr("different times"));
}

TEST(Nowcast, ReachesAnHour) {
    EXPECT_TRUE(check_lead(60));
    EXPECT_TRUE(check_lead(0.5));
    for (const double minutes : {60.1, 0.0, -5.0, std::nan(""), HUGE_VAL}) {
        const auto refused = check_lead(minutes);
        ASSERT_FALSE(refused) << minutes;
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    }
}

TEST(Hindcasts, OfADriftBeatPersistenceAtEachLead) {
    const Sequence sequence = drifting(6);
    const auto motions = pair_motions(sequence.grids, 2);
    ASSERT_TRUE(motions);
    const std::vector<double> leads = {5, 10, 15, 20, 25};
    const auto scores = score_hindcasts(sequence.grids, *motions, leads, 2);
    ASSERT_TRUE(scores) << scores.error().message;
    for (int i = 0; i < 4; ++i) {
        const LeadScore& score = (*scores)[static_cast<std::size_t>(i)];
        EXPECT_EQ(score.hindcasts, 4 - i);  // from the second grid on
        EXPECT_DOUBLE_EQ(score.mean_lead_minutes, score.minutes);
        EXPECT_LT(score.nowcast.mean_absolute_db, score.persistence.mean_absolute_db / 2);
        EXPECT_GT(score.nowcast.csi[1].value_or(0), 0.8);
        EXPECT_LT(score.persistence.csi[1].value_or(1), score.nowcast.csi[1].value_or(0));
    }
    // The last grid is 20 minutes after the second.
    EXPECT_EQ(scores->back().hindcasts, 0);
    EXPECT_EQ(score_text(scores->back()), "error unknown, too few volumes to measure it");
}

TEST(Hindcasts, UseEarlierGridsAlone) {
    // The storms of the last grid are at other places. If a hindcast used the motion toward these
    // places, the hindcast from the second grid for the third grid would change.
    const std::vector<double> leads = {5};
    const Sequence three = drifting(3);
    Sequence four = drifting(3);
    four.grids.clear();
    auto storms = drifting_storms();
    for (grid::Blob& storm : storms) {
        storm.x_km = -storm.x_km;
        storm.y_km += 40;
    }
    four.add(grid::blob_grid(sequence_spec(), storms, 0), 3600);
    four.times_s = {0, 300, 600, 2300};
    four.finish();
    const auto of_three = pair_motions(three.grids, 1), of_four = pair_motions(four.grids, 1);
    ASSERT_TRUE(of_three && of_four);
    const auto a = score_hindcasts(three.grids, *of_three, leads, 1);
    const auto b = score_hindcasts(four.grids, *of_four, leads, 1);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->front().hindcasts, 1);
    EXPECT_EQ(a->front().nowcast.mean_absolute_db, b->front().nowcast.mean_absolute_db);
}

TEST(Hindcasts, AreInWords) {
    LeadScore score;
    score.hindcasts = 3;
    score.nowcast = {4, {0.7, 0.62}};
    score.persistence = {6, {0.5, 0.48}};
    EXPECT_EQ(score_text(score), "measured on 3 hindcasts: CSI(35 dBZ) 0.62, persistence 0.48");
    score.nowcast.csi[1].reset();
    EXPECT_THAT(score_text(score), HasSubstr("CSI(20 dBZ) 0.70, persistence 0.50"));
    score.hindcasts = 1;
    score.nowcast.csi[0].reset();
    EXPECT_EQ(score_text(score), "measured on 1 hindcast: mean error 4.0 dB, persistence 6.0 dB");
}

TEST(NowcastNote, ComesBackFromTheNotesOfAGrid) {
    const auto notes = nowcast_notes(30, "error unknown");
    EXPECT_EQ(notes[0], "nowcast, 30 minutes, by advection");
    const auto found = nowcast_in_notes(notes);
    EXPECT_EQ(found.nowcast, notes[0]);
    EXPECT_EQ(found.score, "error unknown");
    const std::vector<std::string> others = {"the position disagrees", notes[1]};
    EXPECT_EQ(nowcast_in_notes(others).nowcast, "");
    EXPECT_EQ(nowcast_in_notes(others).score, "");
}

}  // namespace
}  // namespace stormcellar::retrieve
