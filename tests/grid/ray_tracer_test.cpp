// Tests each accuracy that stormcellar/grid/ray_tracer.h states, over strata with the hard
// cases: level and falling rays, layers that bend the ray back, high and low antennas, steep beams.
#include "stormcellar/grid/ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "slow_ray.h"

namespace stormcellar::grid {
namespace {

struct Site {
    double latitude_deg;
    double altitude_m;
};
const std::vector<Site> sites = {{78, 50}, {0, 4000}, {-71, -100}};
const std::vector<double> elevations_deg = {-5,  -1,  -0.3, -1e-6, 0,    1e-6, 0.05,
                                            0.3, 0.5, 1.5,  5,     19.5, 60};

RefractivityProfile exponential(double n_units = 313, double scale_m = 7350) {
    return RefractivityProfile::exponential(n_units, scale_m).value();
}

// Returns a profile with these gradients per km from the altitude of the antenna up to each top,
// and the exponential atmosphere above.
RefractivityProfile layered(double altitude_m, std::vector<std::pair<double, double>> tops) {
    double n_units = exponential().at(altitude_m).n_units;
    std::vector<RefractivityLevel> levels = {{altitude_m - 20, n_units}};
    for (const auto& [above_m, gradient_per_km] : tops) {
        const double top_m = altitude_m + above_m;
        n_units += gradient_per_km * 1e-3 * (top_m - levels.back().height_m);
        levels.push_back({top_m, n_units});
    }
    const double share = n_units / exponential().at(levels.back().height_m).n_units;
    for (int i = 0; i < 10; ++i) {
        const double height_m = altitude_m + 2000 + 1500 * i;
        levels.push_back({height_m, share * exponential().at(height_m).n_units});
    }
    return RefractivityProfile::from_levels(levels, "layered").value();
}

RayOptions options_for(const Site& site, double elevation_deg) {
    RayOptions options;
    options.earth_radius_m = gaussian_radius_m(site.latitude_deg);
    options.antenna_altitude_m = site.altitude_m;
    options.elevation_deg = elevation_deg;
    options.behind_m = 1000;
    options.farthest_m = 470e3;
    return options;
}

int turns_before(const TracedRay& ray, double range_m) {
    int turns = 0;
    double last = 0;
    for (const RayNode& node : ray.nodes()) {
        if (node.range_m < 0) continue;
        if (node.range_m > range_m) break;
        if (node.height_rate * last < 0) ++turns;
        if (node.height_rate != 0) last = node.height_rate;
    }
    // The stretch of nodes that holds the range begins at a turning point, or continues the
    // previous stretch.
    const auto next = std::find_if(ray.nodes().begin(), ray.nodes().end(),
                                   [&](const RayNode& node) { return node.range_m > range_m; });
    if (next != ray.nodes().end() && next->height_rate * last < 0) ++turns;
    return turns;
}

struct Worst {
    double height_m = 0, arc_m = 0;
    int checks = 0;
};

// Compares the ray's point at a range with the slow ray at the same height.
void check(const RefractivityProfile& profile, const RayOptions& options, const TracedRay& ray,
           double range_m, Worst& worst) {
    const EarthPoint point = ray.at(range_m);
    if (std::isnan(point.height_m)) return;
    RayOptions forward = options;
    if (range_m < 0) forward.elevation_deg = -options.elevation_deg;
    const int turns = range_m < 0 ? 0 : turns_before(ray, range_m);
    testing::SlowRay slow = testing::slow_ray(profile, forward, turns, point.height_m);
    if (range_m < 0) slow = {-slow.range_m, -slow.arc_m};
    const EarthPoint there =
        ray.at(std::clamp(slow.range_m, ray.nodes().front().range_m, ray.nodes().back().range_m));
    const double stretch_m = slow.range_m - range_m;
    const double height_m = std::abs(there.height_m - point.height_m);
    const double arc_m = std::abs(there.arc_m - slow.arc_m);
    // A NaN or a large error in range must not look like a small error in height.
    ASSERT_LT(std::abs(stretch_m), 200) << options.elevation_deg << " deg, " << range_m << " m";
    worst.height_m = std::max(worst.height_m, height_m);
    worst.arc_m = std::max(worst.arc_m, arc_m);
    ++worst.checks;
}

void check_strata(const Site& site, const RefractivityProfile& profile, Worst& worst) {
    std::mt19937_64 random(20261121);
    for (const double elevation_deg : elevations_deg) {
        const RayOptions options = options_for(site, elevation_deg);
        const TracedRay ray(profile, options);
        std::uniform_real_distribution<double> anywhere(0, ray.nodes().back().range_m);
        for (const double range_m : {-1000.0, -10.0, 10.0, 1e3, 3e4, 1e5, 2.3e5, 4.7e5,
                                     anywhere(random), anywhere(random)}) {
            // The height of a level beam says little about the range near its turning point.
            // ALevelBeamBeginsAsAParabola tests such beams.
            if (range_m < 1e3 && std::abs(elevation_deg) < 0.01) continue;
            check(profile, options, ray, range_m, worst);
        }
    }
}

void expect_within(const Worst& worst, double tolerance_m, int least_checks) {
    EXPECT_LE(worst.height_m, tolerance_m);
    EXPECT_LE(worst.arc_m, tolerance_m);
    EXPECT_GE(worst.checks, least_checks);
    ::testing::Test::RecordProperty("height_um", static_cast<int>(1e6 * worst.height_m));
    ::testing::Test::RecordProperty("arc_um", static_cast<int>(1e6 * worst.arc_m));
}

TEST(RayTracer, SmoothAtmospheres) {
    Worst worst;
    for (const Site& site : sites) {
        check_strata(site, exponential(0), worst);
        check_strata(site, exponential(), worst);
        check_strata(site, exponential(450, 5000), worst);
        check_strata(site, RefractivityProfile::standard(site.latitude_deg), worst);
    }
    expect_within(worst, 1e-3, 1000);
}

TEST(RayTracer, KinkedAtmospheres) {
    Worst worst;
    for (const Site& site : sites) {
        // A dry layer over a moist layer, an inversion, and strong bending near the ground.
        check_strata(site, layered(site.altitude_m, {{500, -60}, {600, -130}, {1500, -20}}), worst);
        check_strata(site, layered(site.altitude_m, {{300, -120}, {310, 40}, {1200, -40}}), worst);
        check_strata(site, layered(site.altitude_m, {{400, 30}, {1000, -50}}), worst);
    }
    expect_within(worst, 1e-3, 700);
}

TEST(RayTracer, Ducts) {
    Worst worst;
    for (const Site& site : sites) {
        check_strata(site, layered(site.altitude_m, {{100, -300}, {1500, -40}}), worst);
        check_strata(site, layered(site.altitude_m, {{300, -40}, {360, -500}, {1500, -35}}), worst);
        check_strata(site, exponential(900, 2000), worst);
    }
    expect_within(worst, 0.01, 500);
}

// A level beam begins as a parabola with the curvature 1 / r + n' / n.
TEST(RayTracer, ALevelBeamBeginsAsAParabola) {
    for (const Site& site : sites) {
        for (const auto& profile :
             {exponential(), layered(site.altitude_m, {{100, -300}, {1500, -40}})}) {
            for (const double elevation_deg : {-1e-2, -1e-6, 0.0, 1e-6, 1e-2}) {
                const RayOptions options = options_for(site, elevation_deg);
                const TracedRay ray(profile, options);
                const auto air = profile.at(site.altitude_m);
                const double n = 1 + 1e-6 * air.n_units;
                const double curvature =
                    1 / (options.earth_radius_m + site.altitude_m) + 1e-6 * air.gradient_per_m / n;
                for (const double range_m : {-1000.0, -10.0, 10.0, 500.0, 1000.0}) {
                    const double path_m = range_m / n;
                    const double rise_m = path_m * std::sin(elevation_deg * 3.14159265359 / 180) +
                                          curvature * path_m * path_m / 2;
                    EXPECT_NEAR(ray.at(range_m).height_m, site.altitude_m + rise_m, 1e-3);
                    EXPECT_NEAR(ray.at(range_m).arc_m,
                                path_m / (1 + site.altitude_m / options.earth_radius_m), 1e-3);
                }
            }
        }
    }
}

// A straight line needs no quadrature, only the triangle of center, antenna and point.
TEST(RayTracer, AVacuumLeavesItStraight) {
    for (const double elevation_deg : {-0.1, 0.0, 0.5, 5.0, 60.0, 89.999, 90.0}) {
        const RayOptions options = options_for({35, 390}, elevation_deg);
        const TracedRay ray(exponential(0), options);
        const long double radius = options.earth_radius_m;
        const long double a = radius + 390;
        const long double e = elevation_deg * 3.14159265358979323846264L / 180;
        for (const double range_m : {-1000.0, 0.0, 1.0, 777.0, 1e5, 4.7e5}) {
            const long double r = range_m;
            const long double up = a + r * std::sin(e);
            const EarthPoint point = ray.at(range_m);
            EXPECT_NEAR(point.height_m,
                        static_cast<double>(std::hypot(up, r * std::cos(e)) - radius), 1e-5);
            EXPECT_NEAR(point.arc_m, static_cast<double>(radius * std::atan2(r * std::cos(e), up)),
                        1e-5);
        }
    }
}

TEST(RayTracer, BouguersInvariantHoldsAtEveryNode) {
    const auto profile = layered(390, {{100, -300}, {400, -40}, {460, -500}, {1500, -35}});
    for (const double elevation_deg : {-0.3, 0.0, 0.2, 3.0}) {
        RayOptions options = options_for({35, 390}, elevation_deg);
        // With the geometric range, the rate of height is the sine of the elevation.
        options.range_kind = RangeKind::geometric;
        const TracedRay ray(profile, options);
        const auto invariant = [&](const RayNode& node) {
            return (1 + 1e-6 * profile.at(node.height_m).n_units) *
                   (options.earth_radius_m + node.height_m) *
                   std::sqrt(1 - node.height_rate * node.height_rate);
        };
        ASSERT_GT(ray.nodes().size(), 30);
        for (const RayNode& node : ray.nodes())
            ASSERT_NEAR(invariant(node), invariant(ray.nodes().front()), 5e-4);
    }
}

TEST(RayTracer, OverUndoesAt) {
    for (const double elevation_deg : elevations_deg) {
        const TracedRay ray(exponential(), options_for({35, 1000}, elevation_deg));
        for (int range_m = -1000; range_m <= ray.nodes().back().range_m; range_m += 731) {
            const EarthPoint point = ray.at(range_m);
            const auto over = ray.over(point.arc_m);
            EXPECT_NEAR(over.range_m, range_m, 1e-3);
            EXPECT_NEAR(over.height_m, point.height_m, 1e-3);
        }
    }
}

TEST(RayTracer, ARayThatMeetsTheFloorEndsThere) {
    const TracedRay ray(exponential(), options_for({35, 100}, -2));
    EXPECT_TRUE(ray.meets_floor());
    EXPECT_EQ(ray.nodes().back().height_m, -500);
    const double end_m = ray.nodes().back().range_m;
    EXPECT_NEAR(end_m, 18.1e3, 400);
    EXPECT_FALSE(std::isnan(ray.at(end_m).arc_m));
    EXPECT_TRUE(std::isnan(ray.at(end_m + 1).arc_m));
    EXPECT_TRUE(std::isnan(ray.over(ray.nodes().back().arc_m + 1).height_m));
    // From 4,000 m, a ray at -1 degree turns upward before it reaches the floor.
    EXPECT_TRUE(TracedRay(exponential(), options_for({35, 4000}, -2.5)).meets_floor());
    EXPECT_FALSE(TracedRay(exponential(), options_for({35, 4000}, -1)).meets_floor());
}

TEST(RayTracer, ADuctHoldsLowRaysAndLetsSteepOnesGo) {
    const auto profile = layered(50, {{100, -400}, {1500, -40}});
    const TracedRay held(profile, options_for({35, 50}, 0.1));
    for (int range_m = 0; range_m <= held.nodes().back().range_m; range_m += 500)
        EXPECT_LT(held.at(range_m).height_m, 150);
    EXPECT_GT(TracedRay(profile, options_for({35, 50}, 0.6)).at(460e3).height_m, 10e3);
}

// Refractivity of 300 N-units at the ground lengthens the optical path of low beams by 3e-4 of
// itself.
TEST(RayTracer, OpticalRangeIsLongerThanThePath) {
    RayOptions options = options_for({35, 0}, 0.5);
    const TracedRay optical(exponential(), options);
    options.range_kind = RangeKind::geometric;
    const TracedRay geometric(exponential(), options);
    const auto excess_m = [&](double path_m) {
        return optical.over(geometric.at(path_m).arc_m).range_m - path_m;
    };
    EXPECT_NEAR(excess_m(230e3), 55.6, 0.5);
    EXPECT_NEAR(excess_m(460e3), 75.0, 2);
}

TEST(RayTracer, HostileProfilesStayBounded) {
    std::vector<RefractivityLevel> levels;
    for (int i = 0; i < 10'000; ++i)
        levels.push_back({1e-3 * i, i % 2 == 0 ? 300 : 300.0019});
    const auto profile = RefractivityProfile::from_levels(levels, "comb").value();
    for (const double elevation_deg : {-90.0, -0.01, 0.0, 0.01, 1.0, 90.0}) {
        const TracedRay ray(profile, options_for({35, 5}, elevation_deg));
        EXPECT_LE(ray.nodes().size(), 30'000);
        EXPECT_GE(ray.nodes().size(), 2);
    }
}

TEST(RayTracer, NotANumberStaysNotANumber) {
    const double nan = std::nan("");
    const TracedRay ray(exponential(), options_for({35, 390}, 0.5));
    EXPECT_TRUE(std::isnan(ray.at(nan).arc_m));
    EXPECT_TRUE(std::isnan(ray.over(nan).range_m));
    for (const double elevation_deg : {nan, 90.5, -91.0}) {
        const TracedRay none(exponential(), options_for({35, 390}, elevation_deg));
        EXPECT_TRUE(none.nodes().empty());
        EXPECT_TRUE(std::isnan(none.at(0).arc_m));
        EXPECT_TRUE(std::isnan(none.over(0).range_m));
    }
}

}  // namespace
}  // namespace stormcellar::grid
