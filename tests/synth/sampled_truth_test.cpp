#include "synth/sampled_truth.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::synth {
namespace {

Scene one_storm() {
    Scene scene;
    scene.site = {"XSYN", 35, -97, 400};
    scene.schedule.start = UtcTime(std::chrono::hours(480000));
    Storm storm;
    storm.footprint.x_m = 60000;
    storm.footprint.y_m = 80000;
    storm.footprint.motion = {20, -10};
    storm.footprint.major_m = storm.footprint.minor_m = 300000;
    storm.peak_dbz = 60;
    scene.weather.storms = {storm};
    return scene;
}

void expect_places_of_the_plane(const Scene& scene, UtcTime time) {
    const SampledTruth sampled(scene);
    const grid::SiteFrame frame(scene.site.latitude_deg, scene.site.longitude_deg);
    for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 17) {
        for (const double arc_m : {10.0, 20000.0, 230000.0, 500000.0}) {
            const auto geo = frame.to_geo({azimuth_deg, arc_m});
            const Point point = sampled.point_of(Place{geo.latitude_deg, geo.longitude_deg, 3000});
            EXPECT_NEAR(point.x_m, arc_m * std::sin(azimuth_deg * degree), 1e-6);
            EXPECT_NEAR(point.y_m, arc_m * std::cos(azimuth_deg * degree), 1e-6);
            EXPECT_EQ(point.z_m, 3000);
            const Echo echo = sampled.at(PolarPlace{azimuth_deg, arc_m, 3000}, time);
            EXPECT_EQ(
                echo.dbz,
                truth_dbz(scene.weather,
                          SampledTruth::point_of(PolarPlace{azimuth_deg, arc_m, 3000}), 90.5));
        }
    }
}

TEST(SampledTruth, PlacesTimesAndPolarPlacesAreThoseOfThePlane) {
    const Scene here = one_storm();
    const UtcTime time = here.schedule.start + std::chrono::milliseconds(90500);
    EXPECT_EQ(SampledTruth(here).seconds_at(time), 90.5);
    for (const Site& site : {Site{"XSYN", 35, -97, 400}, Site{"XSYN", 78, 15, -100},
                             Site{"XSYN", 0, 180, 4000}, Site{"XSYN", -71, -180, 0}}) {
        Scene scene = here;
        scene.site = site;
        expect_places_of_the_plane(scene, time);
    }
}

TEST(SampledTruth, VelocityIsAlongTheBeamOfTheSiteThatAsks) {
    const Scene scene = one_storm();
    const SampledTruth sampled(scene);
    const grid::SiteFrame frame(35, -97);
    const grid::BeamGeometry beam(35, 400);
    const UtcTime time = scene.schedule.start;
    const auto there = frame.to_geo({120, 90000});
    const Place place{there.latitude_deg, there.longitude_deg, 5000};
    const double cosine = std::cos(beam.inverse({90000, 5000}).elevation_deg * degree);
    const double away_mps = (20 * std::sin(120 * degree) - 10 * std::cos(120 * degree)) * cosine;
    EXPECT_NEAR(*sampled.radial_velocity_mps(PolarPlace{120, 90000, 5000}, time), away_mps, 1e-9);
    EXPECT_NEAR(*sampled.radial_velocity_mps(place, {35, -97, 400}, time), away_mps, 1e-9);
    // A site at the same distance on the opposite side sees nearly the opposite velocity.
    const auto beyond = frame.to_geo({120, 180000});
    const Place site{beyond.latitude_deg, beyond.longitude_deg, 400};
    EXPECT_NEAR(*sampled.radial_velocity_mps(place, site, time), -away_mps, 0.02);
    EXPECT_FALSE(sampled.radial_velocity_mps(PolarPlace{120, 90000, 50000}, time));
}

}  // namespace
}  // namespace stormcellar::synth
