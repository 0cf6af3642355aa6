#include "stormcellar/grid/site_frame.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

TEST(SiteFrame, RoundTripsWithinTenNanometres) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> azimuth(0, 360);
    std::uniform_real_distribution<double> arc(1, 500e3);
    const GeoPoint sites[] = {{35, -97},   {0, 0},    {78, 15},   {-71, -179.9}, {13.45, 179.99},
                              {-17, -180}, {52, 180}, {-71, 180}, {90, 0},       {-90, 77}};
    for (const GeoPoint& site : sites) {
        const SiteFrame frame(site.latitude_deg, site.longitude_deg);
        for (int i = 0; i < 2000; ++i) {
            const PolarPoint there{azimuth(random), arc(random)};
            const PolarPoint back = frame.to_polar(frame.to_geo(there));
            EXPECT_NEAR(back.arc_m, there.arc_m, 1e-8);
            double turn_deg = std::abs(back.azimuth_deg - there.azimuth_deg);
            turn_deg = std::min(turn_deg, 360 - turn_deg);
            EXPECT_LT(turn_deg * M_PI / 180 * there.arc_m, 1e-8);
        }
    }
}

// Uses the worked example of Vincenty (1975) as published by Geoscience Australia: Flinders Peak to
// Buninyong on GRS80, which differs from WGS84 by 0.1 mm here.
TEST(SiteFrame, AgreesWithAPublishedLine) {
    const SiteFrame flinders_peak(-(37 + 57 / 60.0 + 3.72030 / 3600),
                                  144 + 25 / 60.0 + 29.52440 / 3600);
    const PolarPoint buninyong = flinders_peak.to_polar(
        {-(37 + 39 / 60.0 + 10.15610 / 3600), 143 + 55 / 60.0 + 35.38390 / 3600});
    EXPECT_NEAR(buninyong.arc_m, 54972.271, 1e-3);
    EXPECT_NEAR(buninyong.azimuth_deg, 306 + 52 / 60.0 + 5.37 / 3600, 1e-5);
}

TEST(SiteFrame, PlaneAxesPointNorthAndEast) {
    EXPECT_EQ(SiteFrame::from_plane(0, 1000).azimuth_deg, 0);
    EXPECT_EQ(SiteFrame::from_plane(1000, 0).azimuth_deg, 90);
    EXPECT_EQ(SiteFrame::from_plane(0, -1000).azimuth_deg, 180);
    EXPECT_EQ(SiteFrame::from_plane(-1000, 0).azimuth_deg, 270);
    EXPECT_EQ(SiteFrame::from_plane(3, 4).arc_m, 5);
    EXPECT_EQ(SiteFrame::from_plane(0, 0).arc_m, 0);
}

TEST(SiteFrame, AzimuthsStayBelow360) {
    EXPECT_EQ(SiteFrame::from_plane(-1e-300, 1).azimuth_deg, 0);
    EXPECT_LT(SiteFrame::from_plane(-1e-9, 1e5).azimuth_deg, 360);
}

TEST(SiteFrame, TheOriginIsAtArcZero) {
    const PolarPoint here = SiteFrame(35, -97).to_polar({35, -97});
    EXPECT_EQ(here.arc_m, 0);
    EXPECT_EQ(here.azimuth_deg, 0);
}

TEST(SiteFrame, CrossesTheAntimeridianAndThePole) {
    EXPECT_NEAR(SiteFrame(0, 179.5).to_polar({0, -179.5}).arc_m, 111319.49, 0.01);
    const PolarPoint over_pole = SiteFrame(89.5, 0).to_polar({89.5, 180});
    EXPECT_EQ(over_pole.azimuth_deg, 0);
    EXPECT_NEAR(over_pole.arc_m, 111694, 1);
}

}  // namespace
}  // namespace stormcellar::grid
