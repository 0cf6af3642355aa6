// Grids, by every method, volumes with the most difficult sweeps and radials. Each test has the
// name of its hazard.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/sweep_choice.h"
#include "tests/hard_cases/grid_case.h"

namespace stormcellar::grid {
namespace {

GridCase about(const std::vector<SweepPlan>& plans, int side = 51, double spacing_m = 5000) {
    return about(plains, plans, side, spacing_m);
}

std::ptrdiff_t count_of(const Grid& grid, CellStatus status) {
    return std::count(grid.status.begin(), grid.status.end(), status);
}

// Two cuts of the VCP were measured at exactly the same elevation, so the distance between their
// beams is 0 everywhere.
TEST(EqualElevations, NoBracketDividesByZero) {
    GridCase given = about({patchy_plan(0.5, 1), patchy_plan(0.5, 2), patchy_plan(1.5, 3)});
    given.volume.sweeps[0].vcp_elevation_deg = 0.3F;
    given.volume.sweeps[1].vcp_elevation_deg = 0.7F;
    ASSERT_EQ(choose_sweeps(given.volume, level2::Moment::ref, 0.475).size(), 3U);
    for (const Method& method : all_methods()) {
        const Grid grid = grid_of(given, method);
        EXPECT_GT(count_of(grid, CellStatus::value), 500) << label(method);
        // Both sweeps hold the same codes, so the grid is the same without one of them.
        if (method.interpolation == Interpolation::beam_weighted) continue;
        GridCase without = given;
        without.volume.sweeps.erase(without.volume.sweeps.begin());
        const Grid other = grid_of(without, method);
        EXPECT_EQ(grid.status, other.status) << label(method);
        EXPECT_EQ(grid.values, other.values) << label(method);
    }
}

// Returns a volume in which two sectors of sweeps were measured above the next sweep.
GridCase with_reversed_radials() {
    GridCase given =
        about({patchy_plan(0.5, 1), patchy_plan(0.9, 2), patchy_plan(1.3, 3), patchy_plan(2.4, 4)});
    for (std::size_t i = 30; i < 120; ++i) {
        given.volume.sweeps[0].radials[i].elevation_deg = 0.85F;
        given.volume.sweeps[1].radials[i].elevation_deg = 0.65F;
    }
    for (std::size_t i = 200; i < 300; ++i) {
        given.volume.sweeps[1].radials[i].elevation_deg = 1.34F;
        given.volume.sweeps[2].radials[i].elevation_deg = 0.95F;
    }
    return given;
}

TEST(ReversedElevations, OfSomeRadialsAreSortedByEveryMethod) {
    expect_sound_by_every_method(with_reversed_radials());
}

// The gridder skips beams above the highest level, but must look further if a higher sweep has
// lower radials.
TEST(ReversedElevations, AboutTheHighestLevel) {
    GridCase given = with_reversed_radials();
    for (const double top_m : {800.0, 1400.0, 2100.0}) {
        given.spec.levels_m = {top_m - 100, top_m};
        expect_sound_by_every_method(given);
    }
}

// The plan of a tile leaves out a quiet sweep (one without echo) between two quiet sweeps. The plan
// must keep the sweep in the middle if radials of another sweep are between the two quiet sweeps.
TEST(ReversedElevations, AmongSweepsOfNoEcho) {
    GridCase given = with_reversed_radials();
    for (const std::size_t quiet : {0U, 1U, 2U}) {
        auto& codes = given.volume.sweeps[quiet].moments[0].codes8;
        std::fill(codes.begin(), codes.end(), std::uint8_t{0});
    }
    expect_sound_by_every_method(given);
}

// Returns a volume with little echo, in which whole tiles and sweeps are quiet, and higher sweeps
// are shorter.
GridCase mostly_quiet(const std::vector<double>& elevations_deg) {
    std::vector<SweepPlan> plans = plans_at(elevations_deg, patchy_plan());
    for (SweepPlan& plan : plans) {
        plan.gates = 150 - 10 * plan.cut;
        plan.code = [cut = plan.cut](int radial, int gate) {
            const bool busy = (radial / 40 + cut) % 5 == 0 && gate % 60 > 40;
            return busy ? patchy_code(radial, 1000.0 * gate + 7000) : below_threshold;
        };
    }
    GridCase given = about(plans, 48, 6000);
    given.volume.sweeps[4].radials.resize(300);  // and a gap
    given.volume.sweeps[4].moments[0].gate_counts.resize(300);
    return given;
}

// The gridder does not sample a sweep in tiles where it is quiet. The same codes in 16 bits, which
// plans do not examine, must give the same bits.
void expect_plans_change_nothing(const GridCase& given, const std::vector<Method>& methods) {
    GridCase busy = given;
    for (level2::Sweep& sweep : busy.volume.sweeps) {
        level2::SweepMoment& moment = sweep.moments[0];
        moment.codes16.assign(moment.codes8.begin(), moment.codes8.end());
        moment.codes8.clear();
        moment.word_size_bits = 16;
    }
    for (const Method& method : methods) {
        const Grid whole = grid_of(given, method);
        const Grid each = grid_of(busy, method);
        ASSERT_EQ(whole.status, each.status) << label(method);
        ASSERT_EQ(whole.values, each.values) << label(method);
        EXPECT_GT(count_of(whole, CellStatus::value), 15) << label(method);
        EXPECT_GT(count_of(whole, CellStatus::no_echo), 3000) << label(method);
    }
}

TEST(TilePlan, LeavesOutOnlyWhatChangesNothing) {
    expect_plans_change_nothing(mostly_quiet({0.5, 0.9, 1.3, 1.8, 2.4, 3.1, 4.0, 6.0}),
                                all_methods());
}

// In the duct, beams cross, and some beams are as wide as several other beams. So every sweep may
// count in a cell.
TEST(TilePlan, LeavesOutNothingThatCountsInADuct) {
    GridCase given = mostly_quiet({-0.3, 0.0, 0.3, 0.6, 0.9, 1.2, 1.5, 1.8});
    given.site.altitude_m = 20;
    given.spec.levels_m = {0, 50, 100, 200, 400, 700, 1000, 1500, 2000, 3000};
    given.profile = duct_under_a_layer();
    std::vector<Method> methods = {method_of(Interpolation::linear),
                                   method_of(Interpolation::beam_weighted),
                                   method_of(Interpolation::beam_weighted, CellExtent::area)};
    for (Method& method : methods)
        method.beam = BeamKind::traced;
    expect_plans_change_nothing(given, methods);
}

TEST(EqualTimes, AndTimesThatRunBackwardsChangeNoCell) {
    const GridCase given = about({patchy_plan(0.5, 1), patchy_plan(1.5, 2)});
    GridCase still = given;
    GridCase backwards = given;
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t radial = 0; radial < 360; ++radial) {
            still.volume.sweeps[i].radials[radial].time = given.volume.sweeps[0].radials[0].time;
            backwards.volume.sweeps[i].radials[radial].time =
                given.volume.sweeps[1 - i].radials[359 - radial].time;
        }
    }
    for (const Method& method : all_methods()) {
        const Grid grid = grid_of(given, method);
        const Grid of_still = grid_of(still, method);
        const Grid of_backwards = grid_of(backwards, method);
        EXPECT_EQ(grid.values, of_still.values) << label(method);
        EXPECT_EQ(grid.values, of_backwards.values) << label(method);
        EXPECT_EQ(of_still.start_time, of_still.end_time);
        EXPECT_LE(of_backwards.start_time, of_backwards.end_time);
    }
}

TEST(AllMissingSweep, OfNoEchoOfFoldedGatesAndWithoutTheMoment) {
    for (const std::uint16_t code : {below_threshold, range_folded}) {
        SweepPlan missing = patchy_plan(1.5, 2);
        missing.code = [code](int, int) { return code; };
        expect_sound_by_every_method(about({patchy_plan(0.5, 1), missing, patchy_plan(2.5, 3)}));
        expect_sound_by_every_method(
            about({missing}), {}, [code](const Method& method, const Grid& grid) {
                const CellStatus state =
                    code == range_folded ? CellStatus::range_folded : CellStatus::no_echo;
                EXPECT_GT(count_of(grid, state), 100) << label(method);
                EXPECT_EQ(count_of(grid, state) + count_of(grid, CellStatus::not_seen),
                          static_cast<std::ptrdiff_t>(grid.status.size()));
            });
    }
    GridCase given = about({patchy_plan(0.5, 1), patchy_plan(1.5, 2), patchy_plan(2.5, 3)});
    std::vector<std::uint16_t>& counts = given.volume.sweeps[1].moments[0].gate_counts;
    std::fill(counts.begin(), counts.end(), std::uint16_t{0});
    expect_sound_by_every_method(given);
    given.volume.sweeps[1].moments.clear();
    expect_sound_by_every_method(given);
}

TEST(SingleSweep, AndOneRadial) {
    expect_sound_by_every_method(about({patchy_plan(0.5, 1)}));
    SweepPlan one = patchy_plan(0.5, 1);
    one.radials = 1;
    one.first_azimuth_deg = 0;
    one.code = [](int, int) { return ref_code(30); };
    GridCase given = about({one}, 51, 500);
    expect_sound_by_every_method(given, {}, [](const Method& method, const Grid& grid) {
        if (method.cell == CellExtent::area) return;
        // Only cells within half a degree of north may be seen.
        for (int iy = 0; iy < grid.spec.ny; ++iy) {
            for (int ix = 0; ix < grid.spec.nx; ++ix) {
                const double off_deg =
                    std::atan2(grid.spec.x_m(ix), grid.spec.y_m(iy)) * 180 / M_PI;
                if (std::abs(off_deg) < 0.51) continue;
                ASSERT_EQ(grid.status[grid.spec.index(ix, iy, 0)], CellStatus::not_seen)
                    << label(method) << " " << off_deg;
            }
        }
    });
}

TEST(AnglesThatAreNoNumbers, LeaveTheirRadialsOutByEveryMethod) {
    const GridCase whole = about({patchy_plan(0.5, 1), patchy_plan(1.5, 2)});
    GridCase spoilt = whole;
    GridCase without = whole;
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> no_angles = {std::nanf(""), infinity, -infinity, 1e30F, -1e30F};
    for (std::size_t i = 0; i < no_angles.size(); ++i) {
        for (std::size_t sweep = 0; sweep < 2; ++sweep) {
            spoilt.volume.sweeps[sweep].radials[20 * i].azimuth_deg = no_angles[i];
            spoilt.volume.sweeps[sweep].radials[20 * i + 7].elevation_deg = no_angles[i];
            without.volume.sweeps[sweep].moments[0].gate_counts[20 * i] = 0;
            without.volume.sweeps[sweep].moments[0].gate_counts[20 * i + 7] = 0;
        }
    }
    for (const Method& method : all_methods()) {
        const Grid grid = grid_of(spoilt, method);
        const Grid expected = grid_of(without, method);
        EXPECT_EQ(grid.status, expected.status) << label(method);
        EXPECT_EQ(grid.values, expected.values) << label(method);
    }
    for (level2::Radial& radial : spoilt.volume.sweeps[0].radials)
        radial.elevation_deg = std::nanf("");
    const Grid one_left = grid_of(spoilt, Method{});
    EXPECT_GT(count_of(one_left, CellStatus::value), 100);
}

TEST(GateSpacingZeroOrLess, IsNoSweep) {
    for (const int spacing_m : {0, -250}) {
        GridCase given = about({patchy_plan(0.5, 1), patchy_plan(1.5, 2)});
        given.volume.sweeps[1].moments[0].gate_spacing_m = spacing_m;
        for (const Method& method : all_methods()) {
            const Grid grid = grid_of(given, method);
            EXPECT_GT(count_of(grid, CellStatus::value), 100) << label(method);
        }
        given.volume.sweeps[0].moments[0].gate_spacing_m = spacing_m;
        for (const Method& method : all_methods()) {
            const auto geometry = make_column_geometry(given.site, given.spec);
            GridderOptions options{.method = method};
            const auto grid = make_grid(given.volume, given.site, **geometry, options);
            if (!grid) continue;  // no sweep is left, which is allowed
            EXPECT_EQ(count_of(*grid, CellStatus::not_seen),
                      static_cast<std::ptrdiff_t>(grid->status.size()))
                << label(method);
        }
    }
}

}  // namespace
}  // namespace stormcellar::grid
