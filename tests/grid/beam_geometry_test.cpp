// Tests each line of the accuracy table in stormcellar/grid/beam_geometry.h, over strata with the
// hard cases: ranges near zero, horizontal and negative elevations, high and low sites, poles and
// equator.
#include "stormcellar/grid/beam_geometry.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/grid/quad.h"

namespace stormcellar::grid {
namespace {

struct Site {
    double latitude_deg;
    double altitude_m;
};
const std::vector<Site> sites = {{35.33, 390}, {0, 0},       {78, 50},  {-71, 4000},
                                 {90, -100},   {-90, 10000}, {45, 0.1}, {13.45, 80}};

// Draws are uniform within each stratum, so that small ranges and angles have their share.
const std::vector<double> range_edges_m = {-1000, -1, 0, 1, 1e3, 1e4, 1e5, 2.3e5, 4.7e5};
const std::vector<double> elevation_edges_deg = {-5, -0.5, -1e-6, 0, 1e-6, 0.5, 2, 20, 60};
constexpr int draws_a_stratum = 200;

template <class Check>
void for_all_strata(double least_range_m, Check check) {
    std::mt19937_64 random(20261121);
    for (const Site& site : sites) {
        for (std::size_t r = 0; r + 1 < range_edges_m.size(); ++r) {
            if (range_edges_m[r] < least_range_m) continue;
            std::uniform_real_distribution<double> range(range_edges_m[r], range_edges_m[r + 1]);
            for (std::size_t e = 0; e + 1 < elevation_edges_deg.size(); ++e) {
                std::uniform_real_distribution<double> elevation(elevation_edges_deg[e],
                                                                 elevation_edges_deg[e + 1]);
                check(site, AntennaPoint{range_edges_m[r], elevation_edges_deg[e]});
                check(site, AntennaPoint{range_edges_m[r + 1], elevation_edges_deg[e + 1]});
                for (int i = 0; i < draws_a_stratum; ++i)
                    check(site, AntennaPoint{range(random), elevation(random)});
            }
        }
    }
}

Quad radians(double degrees) {
    return Quad{degrees} * acosq(-1) / 180;
}

// Computes the two radii of curvature separately, as in textbooks.
Quad gaussian_radius(double latitude_deg) {
    const Quad a = 6378137;
    const Quad f = 1 / (Quad{298257223563} / 1000000000);
    const Quad e2 = f * (2 - f);
    const Quad s = sinq(radians(latitude_deg));
    const Quad w2 = 1 - e2 * s * s;
    const Quad meridian = a * (1 - e2) / (w2 * sqrtq(w2));
    const Quad prime_vertical = a / sqrtq(w2);
    return sqrtq(meridian * prime_vertical);
}

// Result of the textbook's formula, whose terms cancel. Floats of 113 bits have digits to spare.
struct Exact {
    Quad arc_m, height_m;
};
Exact textbook(const Site& site, AntennaPoint gate) {
    const Quad radius = 4 * gaussian_radius(site.latitude_deg) / 3;
    const Quad a = radius + Quad{site.altitude_m};
    const Quad r = gate.range_m;
    const Quad e = radians(gate.elevation_deg);
    const Quad from_centre = sqrtq(r * r + a * a + 2 * r * a * sinq(e));
    return {radius * asinq(r * cosq(e) / from_centre), from_centre - a + Quad{site.altitude_m}};
}

double difference(double a, Quad b) {
    return static_cast<double>(fabsq(Quad{a} - b));
}

TEST(GaussianRadius, IsTheMeanOfBothRadiiOfCurvature) {
    for (int half_degrees = -180; half_degrees <= 180; ++half_degrees) {
        const double latitude_deg = half_degrees / 2.0;
        EXPECT_LT(difference(gaussian_radius_m(latitude_deg), gaussian_radius(latitude_deg)), 4e-9)
            << latitude_deg;
    }
}

TEST(BeamGeometry, ForwardIsWithinANanometreOfTheFormula) {
    double worst_height_m = 0;
    double worst_arc_m = 0;
    for_all_strata(-1000, [&](const Site& site, AntennaPoint gate) {
        const EarthPoint point = BeamGeometry(site.latitude_deg, site.altitude_m).forward(gate);
        const Exact exact = textbook(site, gate);
        worst_height_m = std::max(worst_height_m, difference(point.height_m, exact.height_m));
        worst_arc_m = std::max(worst_arc_m, difference(point.arc_m, exact.arc_m));
    });
    EXPECT_LE(worst_height_m, 1e-9);
    EXPECT_LE(worst_arc_m, 1e-9);
}

TEST(BeamGeometry, InverseUndoesForward) {
    double worst_range_m = 0;
    double worst_elevation_deg = 0;
    for_all_strata(1000, [&](const Site& site, AntennaPoint gate) {
        const BeamGeometry beam(site.latitude_deg, site.altitude_m);
        const AntennaPoint back = beam.inverse(beam.forward(gate));
        worst_range_m = std::max(worst_range_m, std::abs(back.range_m - gate.range_m));
        worst_elevation_deg =
            std::max(worst_elevation_deg, std::abs(back.elevation_deg - gate.elevation_deg));
    });
    EXPECT_LE(worst_range_m, 1e-9);
    EXPECT_LE(worst_elevation_deg, 1e-12);
}

TEST(BeamGeometry, BeamOverAnArcIsThePointThatForwardPutsThere) {
    double worst_range_m = 0;
    double worst_height_m = 0;
    for_all_strata(0, [&](const Site& site, AntennaPoint gate) {
        const BeamGeometry beam(site.latitude_deg, site.altitude_m);
        const EarthPoint point = beam.forward(gate);
        const auto over = beam.over(point.arc_m, gate.elevation_deg);
        worst_range_m = std::max(worst_range_m, std::abs(over.range_m - gate.range_m));
        worst_height_m = std::max(worst_height_m, std::abs(over.height_m - point.height_m));
    });
    EXPECT_LE(worst_range_m, 2e-9);
    EXPECT_LE(worst_height_m, 2e-9);
}

TEST(BeamGeometry, TheAntennaIsAtItsAltitude) {
    const BeamGeometry beam(35, 390);
    const EarthPoint antenna = beam.forward({0, 0.5});
    EXPECT_EQ(antenna.arc_m, 0);
    EXPECT_EQ(antenna.height_m, 390);
    const AntennaPoint back = beam.inverse({0, 390});
    EXPECT_EQ(back.range_m, 0);
    EXPECT_EQ(back.elevation_deg, 0);
    EXPECT_EQ(beam.inverse({0, 1390}).elevation_deg, 90);
}

TEST(BeamGeometry, NotANumberStaysNotANumber) {
    const BeamGeometry beam(35, 390);
    const double nan = std::nan("");
    EXPECT_TRUE(std::isnan(beam.forward({nan, 1}).arc_m));
    EXPECT_TRUE(std::isnan(beam.forward({1, nan}).height_m));
    EXPECT_TRUE(std::isnan(beam.inverse({nan, 1}).range_m));
    EXPECT_TRUE(std::isnan(beam.over(1000, nan).range_m));
}

TEST(BeamGeometry, ABeamNeverPassesOverWhatItsLineDoesNotReach) {
    const BeamGeometry beam(35, 390);
    EXPECT_TRUE(std::isnan(beam.over(1000, 90).range_m));
    EXPECT_TRUE(std::isnan(beam.over(15e6, 0).height_m));
    EXPECT_FALSE(std::isnan(beam.over(460e3, 60).height_m));
}

// Returns the largest difference, at this range and 0.5 degrees, between our heights and the
// heights over a sphere that fits each azimuth.
double radius_error_m(double latitude_deg, double range_m) {
    const Quad f = 1 / (Quad{298257223563} / 1000000000);
    const Quad s = sinq(radians(latitude_deg));
    const Quad w2 = 1 - f * (2 - f) * s * s;
    const Quad across = 6378137 / sqrtq(w2);
    const Quad along = across * (1 - f * (2 - f)) / w2;
    const double ours_m = BeamGeometry(latitude_deg, 0).forward({range_m, 0.5}).height_m;
    double worst_m = 0;
    for (int azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 5) {
        const Quad c = cosq(radians(azimuth_deg));
        const Quad antenna = 4 / (c * c / along + (1 - c * c) / across) / 3;
        const Quad r = range_m;
        const Quad height = sqrtq(r * r + antenna * antenna + 2 * r * antenna * sinq(radians(0.5)));
        worst_m = std::max(worst_m, difference(ours_m, height - antenna));
    }
    return worst_m;
}

TEST(BeamGeometry, TheRadiusAlongTheAzimuthMakesWhatTheHeaderSays) {
    EXPECT_NEAR(radius_error_m(35, 230e3), 7, 0.5);
    EXPECT_NEAR(radius_error_m(35, 460e3), 28, 0.5);
}

TEST(BeamGeometry, TheSameFormulaInFloatsErrsByATenthOfAMetre) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<float> range(1e5F, 4.7e5F);
    std::uniform_real_distribution<float> elevation(-5, 60);
    double worst_m = 0;
    for (const Site& site : sites) {
        const BeamGeometry beam(site.latitude_deg, site.altitude_m);
        const auto a = static_cast<float>(beam.effective_radius_m() + site.altitude_m);
        for (int i = 0; i < 4000; ++i) {
            const float r = range(random);
            const float e = elevation(random);
            const float q = r * r + 2 * r * a * std::sin(e * std::numbers::pi_v<float> / 180);
            const float height_m =
                static_cast<float>(site.altitude_m) + q / (std::sqrt(a * a + q) + a);
            const double exact_m = beam.forward({r, e}).height_m;  // which another test checks
            worst_m = std::max(worst_m, std::abs(static_cast<double>(height_m) - exact_m));
        }
    }
    EXPECT_NEAR(worst_m, 0.1, 0.02);
}

// Uses an independent figure from the charts of radar textbooks. For a site at sea level, over a
// sphere of 4/3 * 6371 km, a beam at 0.5 degrees is 5.12 km high at 230 km.
TEST(BeamGeometry, AgreesWithTheTextbookChart) {
    const EarthPoint point = BeamGeometry(35, 0).forward({230e3, 0.5});
    EXPECT_NEAR(point.height_m, 5120, 5);
}

}  // namespace
}  // namespace stormcellar::grid
