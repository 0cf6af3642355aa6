// Tests the numbers stated in grid/sweep/sweep_mixture.h, grid/beam/beam_pattern.h and
// grid/beam/arc_table.h.
#include "grid/sweep/sweep_mixture.h"

#include <cmath>

#include <gtest/gtest.h>

#include "grid/beam/beam_pattern.h"
#include "stormcellar/grid/beam_geometry.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

TEST(BeamPattern, IsWithinAMillionthOfLongDoubles) {
    for (const float width : {0.55F, 0.95F, 1.0F, 2.0F, 20.0F}) {
        for (int i = -1200; i <= 1200; ++i) {
            const float offset = width * static_cast<float>(i) / 1000;
            const long double ratio =
                static_cast<long double>(offset) / static_cast<long double>(width);
            const long double exact =
                std::abs(ratio) < 1 ? (std::pow(2.0L, -4 * ratio * ratio) - 0.0625L) / 0.9375L : 0;
            ASSERT_NEAR(beam_pattern(offset, width), static_cast<double>(exact), 1e-6) << offset;
        }
    }
    EXPECT_EQ(beam_pattern(0, 0.95F), 1);
    EXPECT_NEAR(beam_pattern(0.475F, 0.95F), (0.5 - 0.0625) / 0.9375, 1e-6)
        << "the pattern is one half at this angle";
}

TEST(ArcTable, ErrsByHalfTheSecondDerivativeTimes250MetresSquared) {
    const auto square = [](double arc_m) { return arc_m * arc_m / 1e6; };  // second derivative 2e-6
    const ArcTable table(200, square);
    double worst = 0;
    for (float arc_m = 0; arc_m < 90e3F; arc_m += 12.5F) {
        const double exact = square(static_cast<double>(arc_m));
        worst = std::max(
            worst, std::abs(static_cast<double>(table.at(ArcTable::place_of(arc_m))) - exact));
    }
    EXPECT_LE(worst, 1e-6 * 250 * 250 + 1e-3);
    EXPECT_GE(worst, 1e-6 * 250 * 250 - 1e-3);
}

// Returns the largest distance between the true place of a gate and its place in the plane through
// the center of a cell, for outlines of 20 km.
double worst_off_plane_m(double elevation_deg, double farthest_m, double latitude_deg,
                         double altitude_m) {
    SweepPlan plan{.elevation_deg = elevation_deg, .gate_spacing_m = 1000};
    const level2::Volume volume = make_volume({plan});
    const auto chosen = choose_sweeps(volume, level2::Moment::ref, 0.475);
    const BeamGeometry beam(latitude_deg, altitude_m);
    const PolarSweep sweep(volume.sweeps[0], chosen[0],
                           BeamModel::four_thirds(latitude_deg, altitude_m),
                           {level2::Moment::ref, 0.475, false, 1001, Averaging::in_db});
    const double corner_m = 10e3 * std::sqrt(2.0);
    double worst_m = 0;
    for (double arc_m = corner_m; arc_m + corner_m < farthest_m; arc_m += 730) {
        const ArcPlace place = ArcTable::place_of(static_cast<float>(arc_m));
        const double center =
            static_cast<double>(sweep.gates().gate_place(0, place).number_and_half) - 0.5;
        const auto gates_a_m = static_cast<double>(sweep.gates().gates_per_m_of_arc(place));
        for (const double off_m : {-corner_m, -5e3, 5e3, corner_m}) {
            const double planar_m = 1000 * (center + off_m * gates_a_m);
            const double exact_m = beam.over(arc_m + off_m, chosen[0].elevation_deg).range_m;
            worst_m = std::max(worst_m, std::abs(planar_m - exact_m));
        }
    }
    return worst_m;
}

// Tests ranges up to 470 km, or up to where the beam is 21 km high (grid/sweep/sweep_mixture.h).
TEST(GatesInside, StandWhereThePlaneThroughTheCentreHasThem) {
    struct Place {
        double latitude_deg;
        double altitude_m;
    };
    for (const Place& place : {Place{35, 390}, Place{78, -100}, Place{0, 4000}, Place{-71, 0}}) {
        const auto worst_m = [&](double elevation_deg, double farthest_m) {
            return worst_off_plane_m(elevation_deg, farthest_m, place.latitude_deg,
                                     place.altitude_m);
        };
        for (const double elevation_deg : {-5.0, -0.5, 0.0, 0.5})
            EXPECT_LT(worst_m(elevation_deg, 470e3), 2.5) << elevation_deg;
        EXPECT_LT(worst_m(1.5, 470e3), 3);
        EXPECT_LT(worst_m(5, 230e3), 4);
        EXPECT_LT(worst_m(19.5, 60e3), 10);
        EXPECT_GT(worst_m(19.5, 60e3), 5) << "the stated accuracy is too loose";
        EXPECT_LT(worst_m(60, 50e3), 90);
    }
}

}  // namespace
}  // namespace stormcellar::grid
