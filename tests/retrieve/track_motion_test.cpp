// Tests that the motion of a track has the error that it states, on tracks whose positions have
// noise.
#include "retrieve/cells/track_motion.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

constexpr UtcTime track_start{std::chrono::hours(1)};
constexpr Motion true_motion{14, -6};

// Returns sightings every five minutes on a straight line to 45 N 7 E, with normal noise of both
// coordinates.
std::vector<CellSighting> noisy_track(std::size_t count, double noise_m, std::mt19937& random) {
    std::normal_distribution<double> noise(0, noise_m);
    std::vector<CellSighting> sightings;
    for (std::size_t i = 0; i < count; ++i) {
        const double before_newest_s = 300.0 * static_cast<double>(count - 1 - i);
        const grid::GeoPoint truth = moved_place({45, 7}, true_motion, -before_newest_s);
        sightings.push_back({track_start + std::chrono::minutes(5 * i),
                             moved_place(truth, {noise(random), noise(random)}, 1)});
    }
    return sightings;
}

TEST(TrackMotion, OfAStraightTrackIsExact) {
    std::mt19937 random(1);
    for (const std::size_t count : {2U, 3U, 10U}) {
        const auto motion = motion_of_track(noisy_track(count, 0, random), std::nullopt, 1000);
        ASSERT_TRUE(motion);
        EXPECT_NEAR(motion->velocity.u_mps, true_motion.u_mps, 1e-6) << count;
        EXPECT_NEAR(motion->velocity.v_mps, true_motion.v_mps, 1e-6) << count;
    }
}

TEST(TrackMotion, ErrsAsMuchAsItSays) {
    constexpr int tracks = 2000;
    std::mt19937 random(48);
    for (const std::size_t count : {2U, 3U, 6U, 10U}) {
        double squares = 0, stated_squares = 0;
        for (int i = 0; i < tracks; ++i) {
            const auto motion =
                motion_of_track(noisy_track(count, 1000, random), std::nullopt, 1000);
            ASSERT_TRUE(motion);
            squares += std::pow(motion->velocity.u_mps - true_motion.u_mps, 2) / tracks;
            stated_squares += std::pow(motion->error_mps, 2) / tracks;
        }
        EXPECT_NEAR(std::sqrt(stated_squares / squares), 1, 0.06) << count;
    }
}

TEST(TrackMotion, ScatterWidensTheError) {
    std::mt19937 random(2);
    const auto calm = motion_of_track(noisy_track(10, 100, random), std::nullopt, 1000);
    const auto wild = motion_of_track(noisy_track(10, 4000, random), std::nullopt, 1000);
    ASSERT_TRUE(calm && wild);
    EXPECT_GT(wild->error_mps, 3 * calm->error_mps);
}

TEST(TrackMotion, IsThePriorUntilTheLineIsBetter) {
    std::mt19937 random(3);
    const TrackMotion prior{{20, 0}, 5};
    const auto one = motion_of_track(noisy_track(1, 0, random), prior, 1000);
    ASSERT_TRUE(one);
    EXPECT_EQ(one->velocity.u_mps, 20);
    EXPECT_FALSE(motion_of_track(noisy_track(1, 0, random), std::nullopt, 1000));
    const auto two = motion_of_track(noisy_track(2, 0, random), prior, 1000);
    const auto ten = motion_of_track(noisy_track(10, 0, random), prior, 1000);
    ASSERT_TRUE(two && ten);
    EXPECT_GT(two->velocity.u_mps, 15);  // between 14 and 20, each with an error of 5 m/s
    EXPECT_NEAR(ten->velocity.u_mps, true_motion.u_mps, 0.2);
    EXPECT_LT(two->error_mps, prior.error_mps);
}

TEST(TrackMotion, SightingsOfOneTimeHaveNoLine) {
    const std::vector<CellSighting> twice(2, {track_start, {45, 7}});
    EXPECT_FALSE(motion_of_track(twice, std::nullopt, 1000));
}

TEST(TrackMotion, ForecastsMoveAndWiden) {
    const auto forecasts = forecast_track({track_start, {45, 7}}, {true_motion, 2}, 1000);
    ASSERT_EQ(forecasts.size(), forecast_minutes.size());
    const auto plane =
        grid::SiteFrame::to_plane(grid::SiteFrame(45, 7).to_polar(forecasts.back().position));
    EXPECT_NEAR(plane.x_m, 14 * 3600, 1e-3);
    EXPECT_NEAR(plane.y_m, -6 * 3600, 1e-3);
    EXPECT_EQ(forecasts.back().time, track_start + std::chrono::hours(1));
    EXPECT_NEAR(forecasts.back().error_m, std::hypot(1000, 7200, own_change_mps * 3600), 1e-6);
}

}  // namespace
}  // namespace stormcellar::retrieve
