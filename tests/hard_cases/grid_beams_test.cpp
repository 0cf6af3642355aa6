// Tests gridding where beams are most difficult. Each test has the name of its hazard, and compares
// the grid with a closed form or with the oracle.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"
#include "tests/grid/quad.h"
#include "tests/hard_cases/grid_case.h"

namespace stormcellar::grid {
namespace {

// ---- Cancellation in the height of the beam

double above_antenna_exactly_m(double range_m, double elevation_deg, double antenna_m) {
    const Quad r = range_m;
    const Quad a = antenna_m;
    const Quad e = Quad{elevation_deg} * acosq(-1) / 180;
    return static_cast<double>(sqrtq(r * r + a * a + 2 * r * a * sinq(e)) - a);
}

// Computes the height by the textbook formula, in floats of type Float.
template <class Float>
double textbook_m(double range_m, double elevation_deg, double antenna_m) {
    const auto r = static_cast<Float>(range_m);
    const auto a = static_cast<Float>(antenna_m);
    const Float sine = std::sin(static_cast<Float>(elevation_deg * M_PI / 180));
    return static_cast<double>(std::sqrt(r * r + a * a + 2 * r * a * sine) - a);
}

TEST(CancellationInBeamHeight, OursKeepsAllDigitsWhereTheTextbooksFormLosesThem) {
    for (const double latitude_deg : {78.0, 0.0, -71.0}) {
        const BeamGeometry beam(latitude_deg, 0);
        const double antenna_m = beam.effective_radius_m();
        double worst = 0, worst_textbook = 0, worst_float_m = 0;
        for (const double range_m : {-1.0, 0.5, 1.0, 10.0, 125.0, 1e3, 1e4, 1e5, 4.7e5}) {
            for (const double elevation_deg : {0.0, 1e-7, 1e-3, 0.5, 5.0, 60.0}) {
                const double exact_m = above_antenna_exactly_m(range_m, elevation_deg, antenna_m);
                const auto relative = [&](double height_m) {
                    return std::abs(height_m - exact_m) / std::abs(exact_m);
                };
                const double ours_m = beam.forward({range_m, elevation_deg}).height_m;
                worst = std::max(worst, relative(ours_m));
                worst_textbook =
                    std::max(worst_textbook,
                             relative(textbook_m<double>(range_m, elevation_deg, antenna_m)));
                worst_float_m = std::max(
                    worst_float_m,
                    std::abs(textbook_m<float>(range_m, elevation_deg, antenna_m) - exact_m));
            }
        }
        EXPECT_LT(worst, 2e-15) << latitude_deg;
        EXPECT_GT(worst_textbook, 0.01) << "the hazard is gone: test something harder";
        EXPECT_GT(worst_float_m, 0.25) << "the hazard is gone: test something harder";
    }
}

// ---- Above, below and at the antenna

// No method sees places above the upper edge of the highest beam.
TEST(ConeOfSilence, IsNotSeenByAnyMethod) {
    SweepPlan even = patchy_plan();
    even.code = [](int, int) { return ref_code(30); };
    GridCase given = about(plains, plans_at({0.5, 2.4, 6.0, 12.0, 19.5}, even), 81, 1000);
    const BeamGeometry beam(plains.latitude_deg, plains.altitude_m);
    expect_sound_by_every_method(given, {}, [&](const Method& method, const Grid& grid) {
        const GridSpec& spec = grid.spec;
        int above = 0, below = 0;
        for (int iy = 0; iy < spec.ny; ++iy) {
            for (int ix = 0; ix < spec.nx; ++ix) {
                const double arc_m = std::hypot(spec.x_m(ix), spec.y_m(iy));
                const double edge_m = beam.over(arc_m, 19.5 + 0.475).height_m;
                for (int level = 0; level < spec.nz(); ++level) {
                    const double height_m = spec.levels_m[static_cast<std::size_t>(level)];
                    // If cells have areas, a level reaches halfway to the next levels, and the
                    // outline of a cell reaches 707 m from its center.
                    const double margin_m = method.cell == CellExtent::area ? 2600 : 2;
                    const CellStatus status = grid.status[spec.index(ix, iy, level)];
                    if (height_m > edge_m + margin_m) {
                        ASSERT_EQ(status, CellStatus::not_seen) << label(method) << " " << arc_m;
                        ++above;
                    } else if (height_m < edge_m - margin_m && height_m > 1000 && arc_m > 5e3 &&
                               arc_m < 30e3) {
                        ASSERT_EQ(status, CellStatus::value) << label(method) << " " << arc_m;
                        ++below;
                    }
                }
            }
        }
        EXPECT_GT(above, 1000);
        EXPECT_GT(below, 1000);
    });
}

TEST(ElevationZeroAndBelow, FromAMountainAndFromBelowTheSea) {
    for (const double altitude_m : {4000.0, -100.0}) {
        SitePosition site = plains;
        site.altitude_m = altitude_m;
        const GridCase given =
            about(site, {patchy_plan(-1.5, 1), patchy_plan(-0.5, 2), patchy_plan(0, 3),
                         patchy_plan(0.5, 4), patchy_plan(1.5, 5)});
        expect_sound_by_every_method(given);
    }
}

TEST(RangeZero, GatesAtAndBehindTheAntennaAreDroppedByEveryMethod) {
    std::vector<SweepPlan> plans = {patchy_plan(0.5, 1), patchy_plan(1.5, 2)};
    for (SweepPlan& plan : plans) {
        plan.first_gate_m = -375;
        plan.gate_spacing_m = 250;
        // Gates behind the antenna have very strong echo.
        plan.code = [](int, int gate) { return ref_code(gate < 2 ? 90 : 20); };
    }
    GridCase given = about(plains, plans, 41, 40);
    given.spec.levels_m = {385, 390, 395, 400, 410};
    const Agreement so_near{1, 0.4};  // beams are within meters of each other
    expect_sound_by_every_method(given, so_near, [](const Method& method, const Grid& grid) {
        int values = 0;
        for (std::size_t i = 0; i < grid.values.size(); ++i) {
            if (grid.status[i] != CellStatus::value) continue;
            ++values;
            ASSERT_NEAR(grid.values[i], 20, 1e-3) << label(method);
        }
        EXPECT_GT(values, 100) << label(method);
    });
    plans[0].first_gate_m = plans[1].first_gate_m = 0;  // the first gate is at the antenna itself
    for (SweepPlan& plan : plans)
        plan.code = [](int, int) { return ref_code(20); };
    given.volume = make_volume(plans);
    expect_sound_by_every_method(given, so_near);
}

// ---- Models of the beam

// A duct bends the lower beams down to the ground, so they see nothing beyond the place where they
// meet the ground.
TEST(BeamsInADuct, WhatNeverPassesOverAColumnIsNotSeen) {
    const std::vector<RefractivityLevel> levels = {{0, 380}, {100, 330}, {1000, 290}, {10000, 90}};
    GridCase given = about(plains, {patchy_plan(-0.3, 1), patchy_plan(0, 2), patchy_plan(0.5, 3),
                                    patchy_plan(1.5, 4)});
    given.site.altitude_m = 20;
    const auto profile = RefractivityProfile::from_levels(levels, "duct");
    ASSERT_TRUE(profile);
    given.profile = *profile;
    for (Method method : all_methods()) {
        method.beam = BeamKind::traced;
        expect_agrees_with_oracle(given, method, grid_of(given, method), {1, 0.3});
    }
}

// In the duct, some beams lose their lower edge to the ground, other beams lose their upper edge,
// and some edges cross the center of their beam. Each sweep has one strength of echo, so that the
// values show the weights of the sweeps.
TEST(BeamsInADuct, ABeamThatLostAnEdgeIsAsWideAsTheHalfThatIsThere) {
    std::vector<SweepPlan> plans = plans_at({-0.3, 0.2, 0.5, 1.5, 2.4}, patchy_plan());
    for (SweepPlan& plan : plans)
        plan.code = [cut = plan.cut](int, int) { return ref_code(10.0 * cut); };
    GridCase given = about(plains, plans);
    given.site.altitude_m = 20;
    given.spec.levels_m = {-300, 0, 50, 100, 150, 250, 400, 700, 1000, 1500, 2000, 3000};
    given.profile = duct_under_a_layer();
    for (Method method : {method_of(Interpolation::linear), method_of(Interpolation::beam_weighted),
                          method_of(Interpolation::beam_weighted, CellExtent::area)}) {
        method.beam = BeamKind::traced;
        expect_agrees_with_oracle(given, method, grid_of(given, method, 9.99, 50.01), {1, 0.3});
    }
}

TEST(FlatEarth, TrianglesGiveTheGates) {
    const GridCase given = about(
        plains, {patchy_plan(-0.3, 1), patchy_plan(0, 2), patchy_plan(0.5, 3), patchy_plan(60, 4)});
    for (Method method : all_methods()) {
        method.beam = BeamKind::flat_earth;
        const Grid grid = grid_of(given, method);
        expect_agrees_with_oracle(given, method, grid);
    }
}

}  // namespace
}  // namespace stormcellar::grid
