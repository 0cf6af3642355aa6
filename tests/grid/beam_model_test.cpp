// Tests each model of the beam against its definition, and the figures that docs/geometry.md gives
// for the 4/3 earth.
#include "stormcellar/grid/beam_model.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

RefractivityProfile exponential() {
    return RefractivityProfile::exponential().value();
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

TEST(BeamModel, FourThirdsIsBeamGeometryBitForBit) {
    std::mt19937_64 random(20261121);
    std::uniform_real_distribution<double> range(-1e3, 470e3);
    std::uniform_real_distribution<double> elevation(-5, 60);
    for (const auto& [latitude_deg, altitude_m] :
         {std::pair{78.0, 50.0}, {0.0, 4000.0}, {-71.0, -100.0}}) {
        const BeamModel model = BeamModel::four_thirds(latitude_deg, altitude_m);
        const BeamGeometry beam(latitude_deg, altitude_m);
        for (int i = 0; i < 2000; ++i) {
            const AntennaPoint gate = {range(random), elevation(random)};
            const BeamPath path = model.path(gate.elevation_deg);
            const EarthPoint point = path.at(gate.range_m);
            const EarthPoint expected = beam.forward(gate);
            ASSERT_TRUE(same_bits(point.arc_m, expected.arc_m));
            ASSERT_TRUE(same_bits(point.height_m, expected.height_m));
            const auto over = path.over(point.arc_m);
            const auto expected_over = beam.over(point.arc_m, gate.elevation_deg);
            ASSERT_TRUE(same_bits(over.range_m, expected_over.range_m));
            ASSERT_TRUE(same_bits(over.height_m, expected_over.height_m));
            ASSERT_TRUE(same_bits(model.inverse(point).range_m, beam.inverse(point).range_m));
            ASSERT_TRUE(
                same_bits(model.inverse(point).elevation_deg, beam.inverse(point).elevation_deg));
        }
    }
    EXPECT_TRUE(std::isnan(BeamModel::four_thirds(35, 0).path(90).over(1000).range_m));
}

TEST(BeamModel, FlatEarthIsATriangle) {
    const BeamModel model = BeamModel::flat_earth(390);
    const BeamPath path = model.path(30);
    EXPECT_NEAR(path.at(100e3).height_m, 50'390, 1e-9);
    EXPECT_NEAR(path.at(100e3).arc_m, 100e3 * std::sqrt(0.75), 1e-9);
    EXPECT_NEAR(path.over(100e3 * std::sqrt(0.75)).range_m, 100e3, 1e-9);
    EXPECT_NEAR(path.over(100e3 * std::sqrt(0.75)).height_m, 50'390, 1e-9);
    EXPECT_NEAR(model.inverse({30e3, 40'390}).range_m, 50e3, 1e-9);
    EXPECT_NEAR(model.inverse({30e3, 30'390}).elevation_deg, 45, 1e-12);
    EXPECT_TRUE(std::isnan(model.path(91).over(1000).range_m));
}

TEST(BeamModel, FlatEarthIsItsFormulaInLongDoubles) {
    for (const double altitude_m : {-100.0, 0.0, 4000.0}) {
        const BeamModel model = BeamModel::flat_earth(altitude_m);
        for (const double elevation_deg : {-5.0, -0.5, 0.0, 1e-6, 0.5, 19.5, 60.0}) {
            const BeamPath path = model.path(elevation_deg);
            const long double e = elevation_deg * 3.14159265358979323846264L / 180;
            for (const double range_m : {-1.0, 0.0, 1.0, 250.0, 3e4, 2.3e5, 4.7e5}) {
                const auto arc_m = static_cast<double>(range_m * std::cos(e));
                const auto height_m = static_cast<double>(altitude_m + range_m * std::sin(e));
                EXPECT_NEAR(path.at(range_m).arc_m, arc_m, 1e-9);
                EXPECT_NEAR(path.at(range_m).height_m, height_m, 1e-9);
                EXPECT_NEAR(path.over(arc_m).range_m, range_m, 1e-9);
                EXPECT_NEAR(path.over(arc_m).height_m, height_m, 1e-9);
                if (range_m < 0) continue;
                EXPECT_NEAR(model.inverse({arc_m, height_m}).range_m, range_m, 1e-9);
            }
        }
    }
}

TEST(BeamModel, NamesSayWhatWasUsed) {
    EXPECT_EQ(BeamModel::flat_earth(0).name(), "flat earth");
    EXPECT_EQ(BeamModel::four_thirds(35, 0).name(), "4/3 earth");
    EXPECT_EQ(BeamModel::traced(35, 0, exponential()).name(),
              "traced, exponential N0 313 H 7350 m");
    EXPECT_EQ(
        BeamModel::traced(35, 0, RefractivityProfile::standard(35), RangeKind::geometric).name(),
        "traced, standard gradient, geometric range");
    EXPECT_EQ(BeamModel::traced(35, 0, exponential()).kind(), BeamKind::traced);
}

// Uses known figures: the height of a gate on the 4/3 earth minus its height on a ray in the
// exponential reference atmosphere. Both have the same geometric range and an antenna at sea level,
// over a sphere of 6371 km (the radius at 35 N is 6370.8 km).
TEST(BeamModel, FourThirdsIsAsFarOffATracedRayAsIsKnown) {
    const BeamModel closed = BeamModel::four_thirds(35, 0);
    const BeamModel traced = BeamModel::traced(35, 0, exponential(), RangeKind::geometric);
    struct Row {
        double elevation_deg;
        std::array<double, 4> too_high_m;  // at 100, 230, 300 and 460 km
    };
    for (const Row& row : {Row{0.5, {6, -70, -222, -1068}}, Row{1.5, {-9, -211, -493, -1752}}}) {
        const std::array<double, 4> ranges_m = {100e3, 230e3, 300e3, 460e3};
        for (std::size_t i = 0; i < 4; ++i) {
            const double higher_m = closed.path(row.elevation_deg).at(ranges_m[i]).height_m -
                                    traced.path(row.elevation_deg).at(ranges_m[i]).height_m;
            EXPECT_NEAR(higher_m, row.too_high_m[i], 1) << row.elevation_deg << ' ' << ranges_m[i];
        }
    }
    // Compares the arc of a gate at 230 km in the same way.
    for (const auto& [elevation_deg, longer_m] :
         {std::pair{0.5, 21.0}, {5.0, 159.0}, {10.0, 324.0}}) {
        EXPECT_NEAR(
            closed.path(elevation_deg).at(230e3).arc_m - traced.path(elevation_deg).at(230e3).arc_m,
            longer_m, 1);
    }
}

// With the gradient that the 4/3 earth assumes, the traced beam must be the 4/3 beam.
TEST(BeamModel, TracedThroughTheStandardGradientIsTheFourThirdsEarthAtLowHeights) {
    const BeamModel closed = BeamModel::four_thirds(35, 10);
    const BeamModel traced =
        BeamModel::traced(35, 10, RefractivityProfile::standard(35), RangeKind::geometric);
    for (int range_m = 1000; range_m <= 100e3; range_m += 1000) {
        EXPECT_NEAR(closed.path(0.5).at(range_m).height_m, traced.path(0.5).at(range_m).height_m,
                    1.0);
    }
}

TEST(BeamModel, TracedPathCoversTheGates) {
    for (const auto& [latitude_deg, altitude_m] :
         {std::pair{35.0, 390.0}, {78.0, -100.0}, {0.0, 4000.0}, {-71.0, 50.0}}) {
        const BeamModel model = BeamModel::traced(latitude_deg, altitude_m, exponential());
        for (const double elevation_deg : {-5.0, -1.0, -0.3, 0.0, 0.02, 0.5, 19.5, 60.0}) {
            const BeamPath path = model.path(elevation_deg);
            int checks = 0;
            for (int range_m = -1000; range_m <= 600e3; range_m += 1711) {
                const EarthPoint point = path.at(range_m);
                if (std::isnan(point.arc_m)) break;  // the ray has reached the floor
                ASSERT_NEAR(path.over(point.arc_m).range_m, range_m, 1e-3);
                ASSERT_NEAR(path.over(point.arc_m).height_m, point.height_m, 1e-3);
                ++checks;
            }
            EXPECT_GT(checks, elevation_deg < 0 ? 3 : 350) << altitude_m << ' ' << elevation_deg;
            EXPECT_EQ(path.at(0).height_m, altitude_m);
            EXPECT_EQ(path.at(0).arc_m, 0);
            EXPECT_TRUE(std::isnan(path.at(600'001).height_m));
        }
    }
}

TEST(BeamModel, TracedInverseFindsTheGate) {
    for (const auto& [latitude_deg, altitude_m] :
         {std::pair{78.0, 50.0}, {0.0, 4000.0}, {-71.0, -100.0}}) {
        const BeamModel model = BeamModel::traced(latitude_deg, altitude_m, exponential());
        int checks = 0;
        for (const double elevation_deg : {-0.8, 0.0, 0.3, 0.5, 5.0, 30.0, 60.0, 89.9}) {
            for (const double range_m : {1e3, 3e4, 1e5, 2.3e5, 4.7e5}) {
                const EarthPoint point = model.path(elevation_deg).at(range_m);
                if (std::isnan(point.arc_m)) continue;
                const AntennaPoint gate = model.inverse(point);
                EXPECT_NEAR(gate.range_m, range_m, 2e-3) << elevation_deg;
                EXPECT_NEAR(gate.elevation_deg, elevation_deg, 1.2e-4 / range_m * 1e3);
                ++checks;
            }
        }
        EXPECT_GE(checks, 35);
        EXPECT_EQ(model.inverse({0, altitude_m}).range_m, 0);
        EXPECT_TRUE(std::isnan(model.inverse({700e3, 5000}).range_m));
        EXPECT_TRUE(std::isnan(model.inverse({std::nan(""), 5000}).range_m));
    }
}

TEST(BeamModel, DifferenceOfAModelFromItselfIsNothing) {
    const BeamModel model = BeamModel::traced(35, 390, exponential());
    const std::vector<double> elevations_deg = {0.5, 19.5};
    const BeamDifference none = greatest_difference(model, model, elevations_deg, {});
    EXPECT_EQ(none.height_m, 0);
    EXPECT_EQ(none.range_m, 0);
    EXPECT_EQ(none.gate_m, 0);
}

// greatest_difference() compares points 500 m apart. This test compares points 10 m apart, whose
// differences may exceed the result by at most the stated limit.
TEST(BeamModel, DifferenceBoundsWhatLiesBetween) {
    const std::vector<RefractivityLevel> levels = {{0, 330},    {300, 300},  {350, 294},
                                                   {1500, 250}, {6000, 140}, {12e3, 60}};
    const auto kinked = RefractivityProfile::from_levels(levels, "kinked").value();
    struct Beam {
        double latitude_deg, altitude_m, elevation_deg;
    };
    for (const auto& [latitude_deg, altitude_m, elevation_deg] :
         {Beam{35, 100, 0}, Beam{35, 100, 0.5}, Beam{35, 100, 3}, Beam{35, 100, 19.5},
          Beam{78, -100, 0.5}, Beam{78, -100, 60}, Beam{-71, 4000, -0.5}, Beam{0, 4000, 0}}) {
        const BeamModel traced = BeamModel::traced(latitude_deg, altitude_m, kinked);
        const BeamModel closed = BeamModel::four_thirds(latitude_deg, altitude_m);
        const std::vector<double> one = {elevation_deg};
        const BeamLimits limits;
        const BeamDifference difference = greatest_difference(closed, traced, one, limits);
        const BeamPath a = closed.path(elevation_deg);
        const BeamPath b = traced.path(elevation_deg);
        double height_m = 0, range_m = 0, gate_m = 0;
        for (int x = 0; x <= 470e3; x += 10) {
            const auto over_a = a.over(x);
            const auto over_b = b.over(x);
            if (!std::isnan(over_b.height_m) && over_b.height_m >= limits.floor_m &&
                over_b.height_m <= limits.ceiling_m && over_b.range_m <= limits.range_m) {
                height_m = std::max(height_m, std::abs(over_a.height_m - over_b.height_m));
                range_m = std::max(range_m, std::abs(over_a.range_m - over_b.range_m));
            }
            const EarthPoint at_a = a.at(x);
            const EarthPoint at_b = b.at(x);
            if (std::isnan(at_b.height_m) || at_b.height_m > limits.ceiling_m ||
                at_b.height_m < limits.floor_m) {
                continue;
            }
            gate_m = std::max(gate_m,
                              std::hypot(at_a.arc_m - at_b.arc_m, at_a.height_m - at_b.height_m));
        }
        EXPECT_LE(height_m, difference.height_m + 0.1) << elevation_deg;
        EXPECT_LE(range_m, difference.range_m + 0.1) << elevation_deg;
        EXPECT_LE(gate_m, difference.gate_m + 0.1) << elevation_deg;
        EXPECT_GT(height_m, 5);
    }
}

TEST(BeamModel, DifferenceIsInfiniteWhereABeamIsLost) {
    // A duct bends this beam into the ground, but on the 4/3 earth the beam rises.
    const std::vector<RefractivityLevel> levels = {{0, 400}, {1000, 200}, {8000, 90}};
    const BeamModel traced =
        BeamModel::traced(35, 100, RefractivityProfile::from_levels(levels, "duct").value());
    const std::vector<double> low = {0.2};
    EXPECT_TRUE(
        std::isinf(greatest_difference(BeamModel::four_thirds(35, 100), traced, low, {}).height_m));
    BeamLimits near;
    near.arc_m = near.range_m = 20e3;
    // Expect half the square of 20 km times the difference of the curvatures, which is 259 minus 39
    // N-units per km.
    EXPECT_NEAR(greatest_difference(BeamModel::four_thirds(35, 100), traced, low, near).height_m,
                0.5 * 20e3 * 20e3 * 220e-9, 5);
}

}  // namespace
}  // namespace stormcellar::grid
