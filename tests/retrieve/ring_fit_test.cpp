// Tests climb(), and fit_ring() on winds that are known, with gaps and wrong fold numbers.
#include "retrieve/cyclone/ring_fit.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "retrieve/cyclone/nelder_mead.h"
#include "tests/retrieve/analytic_hurricane.h"

namespace stormcellar::retrieve {
namespace {

constexpr double distance_m = 80e3;

AnalyticHurricane north_of_radar() {
    AnalyticHurricane hurricane;
    hurricane.center = {0, distance_m};
    hurricane.north_mps = 4;
    hurricane.wave1 = 0.2;
    hurricane.wave1_azimuth_deg = 60;
    return hurricane;
}

// Returns the hurricane without the gates whose azimuth from its center is from 0 to `gap_deg`.
FoldedVolume with_gap(const AnalyticHurricane& hurricane, double gap_deg) {
    FoldedVolume folded = hurricane_volume(hurricane, 63);
    level2::SweepMoment& moment = folded.volume.sweeps[0].moments[0];
    for (std::size_t i = 0; i < moment.codes8.size(); ++i) {
        const double azimuth = (static_cast<double>(i / 912) + 0.5) / 2 * degree;
        const double range = 2000 + 250 * static_cast<double>(i % 912);
        double about = std::atan2(range * std::sin(azimuth) - hurricane.center.x_m,
                                  range * std::cos(azimuth) - hurricane.center.y_m) /
                       degree;
        if (about < 0) about += 360;
        if (about < gap_deg) moment.codes8[i] = 0;
    }
    return folded;
}

std::optional<RingFit> ring_of(const FoldedVolume& folded, double radius_m) {
    const PolarVelocity field(folded.volume, dealias(folded.volume, Dealiasing::off).sweeps[0]);
    RingRequest request;
    request.center = {0, distance_m};
    request.radius_m = radius_m;
    return fit_ring(field, request);
}

TEST(RingFit, FindsEachPartOfTheWind) {
    const AnalyticHurricane hurricane = north_of_radar();
    for (const double radius : {12e3, 35e3, 60e3}) {
        const auto fit = ring_of(hurricane_volume(hurricane, 63), radius);
        ASSERT_TRUE(fit);
        const double mean = hurricane.tangential_mps(radius);
        EXPECT_EQ(fit->waves, 3);
        EXPECT_GT(fit->coverage, 0.98);
        EXPECT_NEAR(fit->tangential_mps, mean, 0.6) << radius;
        EXPECT_NEAR(fit->radial_mps, -hurricane.inflow_mps * mean / hurricane.maximum_mps, 0.6);
        EXPECT_NEAR(fit->along_mps, 4, 0.6) << radius;
        EXPECT_NEAR(fit->wave1_mps, 0.2 * mean, 0.6) << radius;
        EXPECT_GT(fit->tangential_error_mps, 0);
    }
}

TEST(RingFit, FitsFewerWavesAcrossWiderGaps) {
    const AnalyticHurricane hurricane = north_of_radar();
    const double mean = hurricane.tangential_mps(35e3);
    for (const auto& [gap_deg, waves] : {std::pair{20.0, 3}, {45.0, 2}, {80.0, 1}}) {
        const auto fit = ring_of(with_gap(hurricane, gap_deg), 35e3);
        ASSERT_TRUE(fit) << gap_deg;
        EXPECT_EQ(fit->waves, waves) << gap_deg;
        EXPECT_NEAR(fit->largest_gap_deg, gap_deg, 10);
        EXPECT_NEAR(fit->tangential_mps, mean, waves == 1 ? 6 : 1) << gap_deg;
    }
    EXPECT_FALSE(ring_of(with_gap(hurricane, 110), 35e3)) << "the gap is too wide for one wave";
}

TEST(RingFit, RefusesCirclesThatReachTheRadar) {
    const FoldedVolume folded = hurricane_volume(north_of_radar(), 63);
    EXPECT_TRUE(ring_of(folded, 0.88 * distance_m));
    EXPECT_FALSE(ring_of(folded, 0.92 * distance_m));
    EXPECT_FALSE(ring_of(folded, 0));
}

TEST(Climb, FindsTheTopOfAHill) {
    const auto hill = [](grid::PlanePoint at) {
        return 50 - std::hypot(at.x_m - 3000, (at.y_m + 7000) / 2);
    };
    const PlaneMaximum top = climb({-9000, 4000}, 2000, 10, hill);
    EXPECT_NEAR(top.place.x_m, 3000, 50);
    EXPECT_NEAR(top.place.y_m, -7000, 50);
}

TEST(Climb, EndsWhereNothingHasAValue) {
    const auto nothing = [](grid::PlanePoint) { return -std::numeric_limits<double>::infinity(); };
    EXPECT_EQ(climb({0, 0}, 2000, 10, nothing).value, -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace stormcellar::retrieve
