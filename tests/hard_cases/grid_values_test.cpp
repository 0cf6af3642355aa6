// Grids, by every method, values and states that do not mix well. Each test has the name of its
// hazard, and compares the grid with a closed form.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/site_frame.h"
#include "tests/hard_cases/grid_case.h"

namespace stormcellar::grid {
namespace {

// ---- Velocity across the Nyquist fold

constexpr double nyquist_mps = 26;
// Returns a code of 16 bits, in hundredths of a meter a second.
std::uint16_t velocity_code(double mps) {
    return static_cast<std::uint16_t>(std::lround(mps * 100) + 10000);
}

double folded(double mps, double half_mps) {
    return mps - 2 * half_mps * std::floor((mps + half_mps) / (2 * half_mps));
}

// Returns the radial velocity of a wind of about 26 m/s toward the northeast. The velocity folds
// where the wind blows along the beam. The wind grows with range and elevation, so that neighbors
// in all directions straddle the fold.
double radial_wind_mps(double azimuth_deg, double range_m, double elevation_deg) {
    const double along = std::cos((azimuth_deg - 45) * M_PI / 180);
    return (26 + range_m / 1e5 + elevation_deg) * along;
}

GridCase aliased_volume(const std::vector<double>& nyquists_mps) {
    std::vector<SweepPlan> plans;
    for (const double half_mps : nyquists_mps) {
        SweepPlan plan;
        plan.cut = static_cast<int>(plans.size()) + 1;
        plan.elevation_deg = 0.5 + static_cast<double>(plans.size());
        plan.moment = level2::Moment::vel;
        plan.word_size_bits = 16;
        plan.gates = 150;
        plan.code = [half_mps, elevation_deg = plan.elevation_deg](int radial, int gate) {
            const double mps = radial_wind_mps(radial + 0.5, 1000.0 * gate, elevation_deg);
            return velocity_code(half_mps > 0 ? folded(mps, half_mps) : mps);
        };
        plans.push_back(plan);
    }
    GridCase given;
    given.moment = level2::Moment::vel;
    given.site = plains;
    given.volume = make_volume(plans);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        level2::Sweep& sweep = given.volume.sweeps[i];
        sweep.moments[0].scale = 100;
        sweep.moments[0].offset = 10000;
        for (level2::Radial& radial : sweep.radials)
            radial.nyquist_mps = static_cast<float>(nyquists_mps[i]);
    }
    given.spec = plane_about(plains, 61, 3700, {0.5, 1, 1.5, 2, 3, 4, 5});
    return given;
}

double nearest_turn(double a, double b, double half) {
    return std::abs(std::remainder(a - b, 2 * half));
}

// Visits the values beyond 20 km from the site, because cells closer to the site are wide in
// azimuth.
template <class Visit>
void for_each_value(const Grid& grid, Visit visit) {
    for (int iy = 0; iy < grid.spec.ny; ++iy) {
        for (int ix = 0; ix < grid.spec.nx; ++ix) {
            const PolarPoint at = SiteFrame::from_plane(grid.spec.x_m(ix), grid.spec.y_m(iy));
            if (at.arc_m < 20e3) continue;
            for (int level = 0; level < grid.spec.nz(); ++level) {
                const std::size_t cell = grid.spec.index(ix, iy, level);
                if (grid.status[cell] != CellStatus::value) continue;
                visit(at, static_cast<double>(grid.values[cell]));
            }
        }
    }
}

// The wind differs little between the gates of a cell, so any result must be within 5 m/s of the
// wind, measured on the circle of velocities. A mean across the fold would be off by up to 26 m/s.
TEST(NyquistFold, NoValueLiesInItsMiddleByAnyMethod) {
    const GridCase given = aliased_volume({nyquist_mps, nyquist_mps, nyquist_mps});
    for (const Method& method : all_methods(given.moment)) {
        const Grid grid = grid_of(given, method, -nyquist_mps, nyquist_mps);
        expect_agrees_with_oracle(given, method, grid);
        int near_the_fold = 0;
        for_each_value(grid, [&](const PolarPoint& at, double value) {
            const double wind = radial_wind_mps(at.azimuth_deg, at.arc_m, 1.5);
            ASSERT_LT(nearest_turn(value, wind, nyquist_mps), 5)
                << label(method) << " " << at.azimuth_deg << " " << at.arc_m;
            if (std::abs(std::abs(wind) - nyquist_mps) < 1) ++near_the_fold;
        });
        EXPECT_GT(near_the_fold, 300) << "the hazard is gone";
    }
}

// If sweeps fold at different velocities, or do not give their Nyquist velocity (TDWR), the gridder
// makes no mean over two circles. Every value is then a mean over the gates of one sweep, and
// within 5 m/s of the wind on one of the circles.
TEST(NyquistFold, DifferentOrUnknownNyquistVelocitiesAreNeverAveraged) {
    for (const std::vector<double>& nyquists_mps :
         {std::vector<double>{22, 26, 31}, std::vector<double>{26, 0, 26},
          std::vector<double>{0, 0, 0}}) {
        const GridCase given = aliased_volume(nyquists_mps);
        for (const Method& method : all_methods(given.moment)) {
            const Grid grid = grid_of(given, method, -31, 31);
            for_each_value(grid, [&](const PolarPoint& at, double value) {
                const double wind = radial_wind_mps(at.azimuth_deg, at.arc_m, 1.5);
                double off = std::numeric_limits<double>::infinity();
                for (const double half : nyquists_mps) {
                    off = std::min(
                        off, half > 0 ? nearest_turn(value, wind, half) : std::abs(value - wind));
                }
                ASSERT_LT(off, 5) << label(method) << " " << at.azimuth_deg << " " << at.arc_m;
            });
        }
    }
}

TEST(NyquistFold, ANyquistVelocityThatIsNoNumberIsNotKnown) {
    const GridCase unknown = aliased_volume({0, 0, 0});
    GridCase no_number = unknown;
    for (level2::Sweep& sweep : no_number.volume.sweeps) {
        for (level2::Radial& radial : sweep.radials)
            radial.nyquist_mps = std::nanf("");
    }
    for (const Method& method : all_methods(unknown.moment))
        EXPECT_EQ(grid_of(no_number, method).values, grid_of(unknown, method).values);
}

// ---- Reflectivity over 100 dB

// A grid of one column 100 km to the east. The column is in the middle of a gate in each of two
// sweeps.
struct Pair {
    GridCase given;
    double low_m = 0, high_m = 0;
};
using Code = std::function<std::uint16_t(int radial, int gate)>;

Pair pair_of(const Code& low, const Code& high) {
    Pair pair;
    GridCase& given = pair.given;
    std::vector<SweepPlan> plans(2);
    for (std::size_t i = 0; i < 2; ++i) {
        plans[i].cut = static_cast<int>(i) + 1;
        plans[i].elevation_deg = i == 0 ? 0.5 : 1.5;
        plans[i].gates = 150;
        plans[i].code = i == 0 ? low : high;
    }
    given.volume = make_volume(plans);
    given.site = plains;
    const BeamGeometry beam(plains.latitude_deg, plains.altitude_m);
    const double arc_m = beam.forward({100e3, 1}).arc_m;
    pair.low_m = beam.over(arc_m, 0.5).height_m;
    pair.high_m = beam.over(arc_m, 1.5).height_m;
    const GeoPoint there =
        SiteFrame(plains.latitude_deg, plains.longitude_deg).to_geo({90.5, arc_m});
    given.spec = plane_about({"", there.latitude_deg, there.longitude_deg, 0}, 1, 1000, {});
    return pair;
}

Code all_of(std::uint16_t code) {
    return [code](int, int) { return code; };
}

// Returns the weight of the upper sweep by the method, at a height that is the fraction `share` of
// the way up.
double share_of_high(const Method& method, double share) {
    switch (method.interpolation) {
        case Interpolation::nearest:
            return share > 0.5 ? 1 : 0;
        case Interpolation::linear:
        case Interpolation::eight_point:
            return share;
        case Interpolation::beam_weighted:
            break;
    }
    // The sweeps are 1 degree apart, which is more than the width of the beam; `pattern` is the
    // antenna's pattern over this distance.
    const auto pattern = [](double off) { return (std::pow(2, -4 * off * off) - 0.0625) / 0.9375; };
    return pattern(1 - share) / (pattern(share) + pattern(1 - share));
}

TEST(ReflectivityOver100dB, MeansAreThoseOfLongDoubles) {
    const long double weak_dbz = -30, strong_dbz = 70;
    Pair pair = pair_of(all_of(ref_code(-30)), all_of(ref_code(70)));
    for (const double share : {0.02, 0.1, 0.3, 0.49, 0.51, 0.8, 0.98}) {
        pair.given.spec.levels_m = {pair.low_m + share * (pair.high_m - pair.low_m)};
        for (const Method& method : all_methods()) {
            const long double high = static_cast<long double>(share_of_high(method, share));
            long double expected = (1 - high) * weak_dbz + high * strong_dbz;
            if (method.averaging == Averaging::in_z) {
                const long double z = (1 - high) * std::pow(10.0L, weak_dbz / 10) +
                                      high * std::pow(10.0L, strong_dbz / 10);
                expected = 10 * std::log10(z);
            }
            const Grid grid = grid_of(pair.given, method, -31, 71);
            ASSERT_EQ(grid.status[0], CellStatus::value);
            // Heights are accurate to 0.15 m of the 1.7 km between the beams, so values are
            // accurate to 0.01 dB of 100 dB. share_of_high() takes the rises of both beams (meters
            // per degree) as equal, but the rises differ by up to a hundredth.
            const bool by_beam = method.interpolation == Interpolation::beam_weighted;
            EXPECT_NEAR(grid.values[0], static_cast<double>(expected), by_beam ? 0.5 : 0.05)
                << label(method) << " " << share;
        }
    }
}

// In a cell of about a hundred gates of -30 dBZ, one gate of 70 dBZ gives a mean of 50 dBZ in Z,
// and of -29 dBZ in dB.
TEST(ReflectivityOver100dB, OneStrongGateAmongAHundredWeakOnesByArea) {
    const Code one_of_100 = [](int radial, int gate) {
        return ref_code(radial == 90 && gate == 100 ? 70 : -30);
    };
    Pair pair = pair_of(one_of_100, one_of_100);
    pair.given.spec.spacing_m = 13000;
    pair.given.spec.levels_m = {(pair.low_m + pair.high_m) / 2};
    for (const Method& method : all_methods()) {
        if (method.cell != CellExtent::area) continue;
        const Grid grid = grid_of(pair.given, method, -31, 71);
        ASSERT_EQ(grid.status[0], CellStatus::value);
        const auto value = static_cast<double>(grid.values[0]);
        // The cell has 12 to 14 gates along the beam, and 7 or 8 radials across the beam. The
        // radials are 1.75 km apart.
        const double least =
            method.averaging == Averaging::in_z ? 70 - 10 * std::log10(8 * 14) : -30;
        const double most =
            method.averaging == Averaging::in_z ? 70 - 10 * std::log10(7 * 12) : -30 + 100.0 / 84;
        EXPECT_GE(value, least - 0.01) << label(method);
        EXPECT_LE(value, most + 0.01) << label(method);
    }
}

// A damaged scale makes every value of a sweep infinite or impossible. The gridder ignores the
// sweep, so the cell at the height of this sweep is not seen. The cell at the height of the other
// sweep has the value of the other sweep.
TEST(ValuesBeyondAllReason, AreNoValues) {
    for (const float scale : {1e-38F, -1e-38F, 1e-3F, std::numeric_limits<float>::denorm_min()}) {
        Pair pair = pair_of(all_of(ref_code(40)), all_of(ref_code(10)));
        pair.given.volume.sweeps[0].moments[0].scale = scale;
        pair.given.spec.levels_m = {pair.low_m, pair.high_m};
        for (const Method& method : all_methods()) {
            if (method.cell == CellExtent::area) continue;  // levels reach halfway
            const Grid grid = grid_of(pair.given, method);
            EXPECT_EQ(grid.status[0], CellStatus::not_seen) << label(method) << " " << scale;
            EXPECT_EQ(grid.status[1], CellStatus::value) << label(method) << " " << scale;
            EXPECT_NEAR(grid.values[1], 10, 0.01) << label(method) << " " << scale;
        }
    }
}

// Codes of 16 bits can express 30,000 dBZ, whose Z is more than a float can hold.
TEST(ValuesBeyondAllReason, AreNeverInfiniteInZ) {
    Pair pair = pair_of(all_of(ref_code(40)), all_of(ref_code(10)));
    for (level2::Sweep& sweep : pair.given.volume.sweeps) {
        level2::SweepMoment& moment = sweep.moments[0];
        moment.codes16.assign(moment.codes8.size(), 60000);
        moment.codes8.clear();
        moment.word_size_bits = 16;
    }
    pair.given.spec.levels_m = {(pair.low_m + pair.high_m) / 2};
    for (const Method& method : all_methods())
        EXPECT_EQ(grid_of(pair.given, method, 0, 40000).status[0], CellStatus::value);
}

// ---- The status rule, by every method

struct Mixed {
    const char* what;
    std::uint16_t low, high;  // codes; 255 means not seen
    double share;             // of the upper sweep
    CellStatus expected;
};
constexpr std::uint16_t unseen_code = 255;
constexpr std::uint16_t ambiguous = 2;  // in VELD alone
const std::uint16_t echo = ref_code(30);

// Returns pairs of states, with shares below and above one half, and the result by the rule in
// docs/geometry.md.
std::vector<Mixed> mixtures_of(level2::Moment moment) {
    const auto value = CellStatus::value;
    const auto quiet = CellStatus::no_echo;
    const auto fold = CellStatus::range_folded;
    const auto unseen = CellStatus::not_seen;
    const auto unsure = CellStatus::ambiguous;
    std::vector<Mixed> mixtures = {
        {"value, value", echo, echo, 0.4, value},
        {"value, some no echo", echo, below_threshold, 0.4, value},
        {"value, more no echo", echo, below_threshold, 0.6, quiet},
        {"no echo, more value", below_threshold, echo, 0.6, value},
        {"value, some folded", echo, range_folded, 0.4, value},
        {"value, more folded", echo, range_folded, 0.6, fold},
        {"value, some not seen", echo, unseen_code, 0.4, value},
        {"value, more not seen", echo, unseen_code, 0.6, unseen},
        {"no echo, no echo", below_threshold, below_threshold, 0.6, quiet},
        {"no echo, some folded", below_threshold, range_folded, 0.4, quiet},
        {"no echo, more folded", below_threshold, range_folded, 0.6, fold},
        {"no echo, some not seen", below_threshold, unseen_code, 0.4, quiet},
        {"no echo, more not seen", below_threshold, unseen_code, 0.6, unseen},
        {"folded, folded", range_folded, range_folded, 0.4, fold},
        {"folded, some not seen", range_folded, unseen_code, 0.4, fold},
        {"folded, more not seen", range_folded, unseen_code, 0.6, unseen},
        {"not seen, more value", unseen_code, echo, 0.6, value},
        {"not seen, not seen", unseen_code, unseen_code, 0.4, unseen},
    };
    if (!level2::facts_of(moment).is_derived) return mixtures;
    for (const Mixed& mixed : {
             Mixed{"value, some ambiguous", echo, ambiguous, 0.4, value},
             Mixed{"value, more ambiguous", echo, ambiguous, 0.6, unsure},
             Mixed{"ambiguous, more value", ambiguous, echo, 0.6, value},
             Mixed{"no echo, some ambiguous", below_threshold, ambiguous, 0.4, quiet},
             Mixed{"no echo, more ambiguous", below_threshold, ambiguous, 0.6, unsure},
             Mixed{"folded, some ambiguous", range_folded, ambiguous, 0.4, fold},
             Mixed{"folded, more ambiguous", range_folded, ambiguous, 0.6, unsure},
             Mixed{"ambiguous, ambiguous", ambiguous, ambiguous, 0.4, unsure},
             Mixed{"ambiguous, some not seen", ambiguous, unseen_code, 0.4, unsure},
             Mixed{"ambiguous, more not seen", ambiguous, unseen_code, 0.6, unseen},
         })
        mixtures.push_back(mixed);
    return mixtures;
}

// Makes the sweeps hold another moment, with the same codes.
void rename_moment(GridCase& given, level2::Moment moment) {
    given.moment = moment;
    for (level2::Sweep& sweep : given.volume.sweeps)
        sweep.moments[0].moment = moment;
}

// Expects the cell of a mixture to have the status by the rule. In a derived moment, only the gates
// with a value may enter the value.
void expect_by_the_rule(const Mixed& mixed, const GridCase& given, const Method& method) {
    const Grid grid = grid_of(given, method);
    ASSERT_EQ(grid.status[0], mixed.expected) << mixed.what << ", " << label(method);
    if (level2::facts_of(given.moment).is_derived && mixed.expected == CellStatus::value) {
        EXPECT_FLOAT_EQ(grid.values[0], 30) << mixed.what << ", " << label(method);
    }
}

// Cuts the radials off 10 km before the column, because a place beyond the last gate of a radial is
// not seen.
void hide(level2::Sweep& sweep) {
    for (std::uint16_t& count : sweep.moments[0].gate_counts)
        count = 90;
}

class StatusRule : public ::testing::TestWithParam<level2::Moment> {};

TEST_P(StatusRule, EveryPairOfStatesUpTheColumnByEveryMethod) {
    for (const Mixed& mixed : mixtures_of(GetParam())) {
        Pair pair = pair_of(all_of(mixed.low), all_of(mixed.high));
        rename_moment(pair.given, GetParam());
        if (mixed.low == unseen_code) hide(pair.given.volume.sweeps[0]);
        if (mixed.high == unseen_code) hide(pair.given.volume.sweeps[1]);
        pair.given.spec.levels_m = {pair.low_m + mixed.share * (pair.high_m - pair.low_m)};
        for (const Method& method : all_methods(GetParam()))
            expect_by_the_rule(mixed, pair.given, method);
    }
}

// The states are side by side within each sweep, so the rule mixes the two radials about a point,
// or all gates of an area. Radials up to number 90 have one state, and all other radials the other
// state.
TEST_P(StatusRule, EveryPairOfStatesAcrossRadialsByEveryMethod) {
    for (const Mixed& mixed : mixtures_of(GetParam())) {
        if (mixed.low == unseen_code || mixed.high == unseen_code) continue;
        const Code two = [&mixed](int radial, int) {
            return radial <= 90 ? mixed.low : mixed.high;
        };
        Pair pair = pair_of(two, two);
        rename_moment(pair.given, GetParam());
        const double arc_m =
            BeamGeometry(plains.latitude_deg, plains.altitude_m).forward({100e3, 1}).arc_m;
        const auto move_to = [&](double azimuth_deg) {
            const GeoPoint there =
                SiteFrame(plains.latitude_deg, plains.longitude_deg).to_geo({azimuth_deg, arc_m});
            pair.given.spec.center_latitude_deg = there.latitude_deg;
            pair.given.spec.center_longitude_deg = there.longitude_deg;
        };
        // The border is at 91 degrees; the center of the cell is slightly on either side of it.
        move_to(90.5 + mixed.share);
        pair.given.spec.levels_m = {(pair.low_m + pair.high_m) / 2};
        for (const Method& method : all_methods(GetParam())) {
            if (method.cell == CellExtent::area) continue;  // areas are tested below
            expect_by_the_rule(mixed, pair.given, method);
        }
        // A cell of 29 km has 16 or 17 radials. The center of the cell is 2 radials from the border
        // between the states.
        pair.given.spec.spacing_m = 29000;
        move_to(mixed.share < 0.5 ? 89 : 93);
        for (const Method& method : all_methods(GetParam())) {
            if (method.cell != CellExtent::area) continue;
            expect_by_the_rule(mixed, pair.given, method);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Moments, StatusRule,
                         ::testing::Values(level2::Moment::ref, level2::Moment::veld));

// In the mean for a value, a gate of no echo counts with its weight, as a value at its detection
// limit.
TEST(NoEcho, EntersAtItsDetectionLimitByEveryMethod) {
    Pair pair = pair_of(all_of(echo), all_of(below_threshold));
    const double share = 0.35;
    pair.given.spec.levels_m = {pair.low_m + share * (pair.high_m - pair.low_m)};
    const double limit_dbz = -41.5 + 20 * std::log10(100);
    for (const Method& method : all_methods()) {
        const double high = share_of_high(method, share);
        double expected = (1 - high) * 30 + high * limit_dbz;
        if (method.averaging == Averaging::in_z) {
            expected = 10 * std::log10((1 - high) * std::pow(10, 3.0) +
                                       high * std::pow(10, limit_dbz / 10));
        }
        const Grid grid = grid_of(pair.given, method);
        ASSERT_EQ(grid.status[0], CellStatus::value) << label(method);
        EXPECT_NEAR(grid.values[0], expected, 0.2) << label(method);
    }
}

// ---- Patches of ambiguous gates

double smooth_mps(double east_km, double north_km) {
    return 30 + 20 * std::sin(east_km / 31) * std::sin(north_km / 37);
}

// Returns smooth velocities with patches of no echo, of range folding and of ambiguous gates.
GridCase ambiguous_patches() {
    SweepPlan plan = patchy_plan();
    plan.moment = level2::Moment::veld;
    plan.code = [](int radial, int gate) {
        const double azimuth = (radial + 0.5) * M_PI / 180;
        const double east_km = gate * std::sin(azimuth), north_km = gate * std::cos(azimuth);
        if (std::sin(east_km / 13) * std::cos(north_km / 11) > 0.5) return ambiguous;
        const std::uint16_t patch = patchy_code(radial + 0.5, 1000.0 * gate);
        return patch < 2 ? patch : ref_code(smooth_mps(east_km, north_km));
    };
    GridCase given = about(plains, plans_at({0.5, 1.5, 2.5, 3.5, 5}, plan));
    given.moment = level2::Moment::veld;
    return given;
}

// A cell uses gates within 7 km, over which velocities differ by less than 5 m/s. So if the value
// of a cell is 5 m/s or more off the velocity at its place, no gate around the cell has this value.
TEST(AmbiguousPatches, KeepTheirPlacesAndInventNoVelocityByAnyMethod) {
    const GridCase given = ambiguous_patches();
    expect_sound_by_every_method(given, {}, [&](const Method& method, const Grid& grid) {
        EXPECT_GT(std::ranges::count(grid.status, CellStatus::ambiguous), 1000) << label(method);
        for_each_value(grid, [&](const PolarPoint& at, double value) {
            const double azimuth = at.azimuth_deg * M_PI / 180, arc_km = at.arc_m / 1000;
            ASSERT_NEAR(value, smooth_mps(arc_km * std::sin(azimuth), arc_km * std::cos(azimuth)),
                        5)
                << label(method) << " " << at.azimuth_deg << " " << at.arc_m;
        });
    });
}

}  // namespace
}  // namespace stormcellar::grid
