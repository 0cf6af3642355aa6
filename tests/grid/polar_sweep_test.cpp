#include "grid/sweep/polar_sweep.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

const BeamGeometry beam(35, 390);
const BeamModel model = BeamModel::four_thirds(35, 390);

ArcPlace place_at(double arc_m) {
    const double along = arc_m / ArcTable::step_m;
    const auto index = static_cast<std::size_t>(along);
    return {index, static_cast<float>(along - static_cast<double>(index))};
}

PolarSweepOptions options(level2::Moment moment, double half_beam_deg = 0.475) {
    return {moment, half_beam_deg, false, 1001, Averaging::in_db, true};
}

struct Prepared {
    explicit Prepared(const SweepPlan& plan, double half_beam_deg = 0.475)
        : volume(make_volume({plan})),
          chosen(choose_sweeps(volume, plan.moment, half_beam_deg)),
          sweep(volume.sweeps[0], chosen[0], model, options(plan.moment, half_beam_deg)) {}
    [[nodiscard]] Sample at(double azimuth_deg, double arc_m) const {
        return sweep.sample(static_cast<float>(azimuth_deg), place_at(arc_m));
    }
    // Samples the place on the ground below the beam at this range.
    [[nodiscard]] Sample at_range(double azimuth_deg, double range_m) const {
        return at(azimuth_deg, beam.forward({range_m, chosen[0].elevation_deg}).arc_m);
    }
    level2::Volume volume;
    std::vector<ChosenSweep> chosen;
    PolarSweep sweep;
};

// Sites whose latitudes and altitudes span those of all real sites.
struct Stratum {
    double latitude_deg, altitude_m;
};
constexpr Stratum strata[] = {{35, 390}, {78, -100}, {0, 4000}, {-71, 0}};

PolarSweep sweep_of(const Prepared& prepared, const BeamModel& other) {
    return {prepared.volume.sweeps[0], prepared.chosen[0], other, options(level2::Moment::ref)};
}

// Tests the tables of a sweep against the model, at random arcs everywhere below `ceiling_m`.
void expect_tables_of(const BeamModel& other, double elevation_deg, double ceiling_m) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> arc(0, 499e3);
    const Prepared prepared({.elevation_deg = elevation_deg, .gate_spacing_m = 250});
    const PolarSweep sweep = sweep_of(prepared, other);
    const double center_deg = prepared.chosen[0].elevation_deg;
    const BeamPath center = other.path(center_deg);
    const BeamPath lower = other.path(center_deg - 0.475);
    const BeamPath upper = other.path(center_deg + 0.475);
    int compared = 0;
    for (int i = 0; i < 1500; ++i) {
        // Draw a third of the arcs close to the radar.
        const double arc_m = i % 3 == 0 ? arc(random) / 50 : arc(random);
        const auto exact = center.over(arc_m);
        const auto low = lower.over(arc_m + ArcTable::step_m);
        const auto high = upper.over(arc_m + ArcTable::step_m);
        if (std::isnan(exact.height_m) || std::isnan(low.height_m) || std::isnan(high.height_m))
            continue;
        if (exact.height_m > ceiling_m) continue;
        ++compared;
        const ArcPlace place = place_at(arc_m);
        const BeamHeights heights = sweep.beam().heights(place);
        ASSERT_NEAR(heights.center_m, exact.height_m, 0.15) << elevation_deg << ' ' << arc_m;
        ASSERT_NEAR(heights.lower_m, lower.over(arc_m).height_m, 0.15) << elevation_deg;
        ASSERT_NEAR(heights.upper_m, upper.over(arc_m).height_m, 0.15) << elevation_deg;
        const double range_m =
            250 * (static_cast<double>(sweep.gates().gate_place(0, place).number_and_half) - 0.5);
        ASSERT_NEAR(range_m, exact.range_m, 0.15) << elevation_deg << ' ' << arc_m;
    }
    EXPECT_GT(compared, 50) << elevation_deg;
}

TEST(PolarSweep, TablesAreWithin15CentimetresOfTheModel) {
    for (const auto& [latitude_deg, altitude_m] : strata) {
        const BeamModel four_thirds = BeamModel::four_thirds(latitude_deg, altitude_m);
        const BeamModel traced =
            BeamModel::traced(latitude_deg, altitude_m, RefractivityProfile::reference());
        for (const double elevation_deg : {-5.0, -0.5, 0.0, 0.5, 4.3, 19.5, 45.0, 60.0}) {
            expect_tables_of(four_thirds, elevation_deg, 1e6);
            expect_tables_of(traced, elevation_deg, 1e6);
        }
    }
}

TEST(PolarSweep, ARadialsOwnElevationIsWithin25CentimetresOfTheModel) {
    std::mt19937_64 random(10);
    for (const auto& [latitude_deg, altitude_m] : strata) {
        const BeamGeometry exact(latitude_deg, altitude_m);
        for (const double elevation_deg : {-5.0, -0.5, 0.0, 0.5, 4.3, 10.0, 20.0, 45.0, 60.0}) {
            const Prepared prepared({.elevation_deg = elevation_deg});
            const PolarSweep sweep =
                sweep_of(prepared, BeamModel::four_thirds(latitude_deg, altitude_m));
            // No tested gate is higher than 21 km or farther than 470 km.
            const double slope = std::tan(std::abs(elevation_deg) / 57.3);
            const double farthest_m = slope > 0 ? std::min(470e3, 21e3 / slope) : 470e3;
            std::uniform_real_distribution<double> arc(0, farthest_m);
            for (int i = 0; i < 2010; ++i) {
                const double arc_m = arc(random);
                const double offset_deg = 0.475 * (static_cast<double>(i % 201) / 100 - 1);
                const double own_deg = prepared.chosen[0].elevation_deg + offset_deg;
                const auto heights =
                    sweep.beam().heights(place_at(arc_m), static_cast<float>(offset_deg));
                ASSERT_NEAR(heights.center_m, exact.over(arc_m, own_deg).height_m, 0.25) << arc_m;
                ASSERT_NEAR(heights.lower_m, exact.over(arc_m, own_deg - 0.475).height_m, 1);
                ASSERT_NEAR(heights.upper_m, exact.over(arc_m, own_deg + 0.475).height_m, 1);
            }
        }
    }
}

TEST(PolarSweep, TakesTheNearestGate) {
    SweepPlan plan;
    plan.first_gate_m = 2125;
    plan.gate_spacing_m = 250;
    plan.gates = 1800;
    plan.code = [](int, int gate) { return static_cast<std::uint16_t>(2 + gate % 250); };
    const Prepared prepared(plan);
    const auto value = [](int gate) { return static_cast<float>(2 + gate % 250 - 66) / 2; };
    for (const int gate : {0, 1, 249, 250, 900, 1799}) {
        const double center_m = 2125 + 250.0 * gate;
        for (const double off_m : {-124.8, 0.0, 124.8}) {
            const Sample sample = prepared.at_range(10.5, center_m + off_m);
            ASSERT_EQ(sample.status, CellStatus::value) << gate;
            EXPECT_EQ(sample.value, value(gate)) << gate << " " << off_m;
        }
    }
    EXPECT_EQ(prepared.at_range(10.5, 2125 - 125.2).status, CellStatus::not_seen);
    EXPECT_EQ(prepared.at_range(10.5, 2125 + 1799 * 250 + 125.2).status, CellStatus::not_seen);
}

// Tests stretches of gates against single gates, with echo, range folded and no echo in them.
// Regression of 2026-11-22: for an empty stretch beyond the last gate, the code read sums of limits
// beyond the end of their array, which crashed once in a few thousand volumes.
TEST(PolarSweep, StretchesOfGatesAreTheirGates) {
    std::mt19937 random(3);
    SweepPlan plan;
    plan.code = [](int radial, int gate) {
        if (gate % 50 < 30) return 0;
        return (radial * 7 + gate * 13) % 5 == 0 ? 1
               : (radial + gate) % 3 == 0        ? 0
                                                 : 60 + gate % 40;
    };
    for (const CellExtent cell : {CellExtent::point, CellExtent::area}) {
        const Prepared prepared(plan);
        PolarSweepOptions with = options(plan.moment);
        with.cell = cell;
        const PolarSweep sweep(prepared.volume.sweeps[0], prepared.chosen[0], model, with);
        const std::int32_t gates = sweep.gates().gate_place(0, place_at(0)).end;
        for (int i = 0; i < 2000; ++i) {
            const int position = static_cast<int>(random() % sweep.gates().radial_count());
            const auto first = static_cast<std::int32_t>(random() % static_cast<unsigned>(gates));
            const auto end = first + static_cast<std::int32_t>(
                                         random() % static_cast<unsigned>(gates - first + 1));
            Mixture together, one_by_one;
            sweep.gates().add_gates(position, first, end, together);
            for (std::int32_t gate = first; gate < end; ++gate)
                one_by_one.add(sweep.gates().gate(position, gate), 1, sweep.gates().blending());
            EXPECT_EQ(together.weight(), one_by_one.weight());
            EXPECT_EQ(together.is_all_quiet(), one_by_one.is_all_quiet());
            const CellResult a = together.result(sweep.gates().blending());
            const CellResult b = one_by_one.result(sweep.gates().blending());
            EXPECT_EQ(a.status, b.status);
            if (b.status == CellStatus::value) {
                EXPECT_NEAR(a.value, b.value, 2e-3);
            }
        }
        Mixture nothing;
        sweep.gates().add_gates(0, gates, gates, nothing);
        sweep.gates().add_gates(0, 2'000'000'000, gates, nothing);
        EXPECT_EQ(nothing.weight(), 0);
    }
}

TEST(PolarSweep, GatesAtNegativeRangeAreDropped) {
    SweepPlan plan;
    plan.first_gate_m = -375;
    plan.gate_spacing_m = 250;
    plan.code = [](int, int gate) { return ref_code(gate); };
    const Prepared prepared(plan);
    EXPECT_EQ(prepared.at_range(10.5, 0).status, CellStatus::value);
    EXPECT_EQ(prepared.at_range(10.5, 0).value, 2) << "the gate at 125 m, not the gate at -125 m";
    EXPECT_EQ(prepared.at_range(10.5, 300).value, 3);
}

TEST(PolarSweep, CodesBecomeStates) {
    SweepPlan plan;
    plan.code = [](int radial, int) {
        return radial == 0 ? below_threshold : radial == 1 ? range_folded : ref_code(30);
    };
    const Prepared prepared(plan);
    EXPECT_EQ(prepared.at(0.5, 50e3).status, CellStatus::no_echo);
    EXPECT_EQ(prepared.at(1.5, 50e3).status, CellStatus::range_folded);
    EXPECT_EQ(prepared.at(2.5, 50e3).status, CellStatus::value);
    EXPECT_NEAR(prepared.at(0.5, 50e3).limit, -7.5, 0.1);
}

TEST(PolarSweep, SixteenBitCodes) {
    SweepPlan plan;
    plan.moment = level2::Moment::phi;
    plan.word_size_bits = 16;
    plan.code = [](int, int gate) { return static_cast<std::uint16_t>(gate == 50 ? 1000 : 1); };
    const Prepared prepared(plan);
    EXPECT_EQ(prepared.at_range(10.5, 50e3).value, (1000 - 66) / 2.0F);
    EXPECT_EQ(prepared.at_range(10.5, 60e3).status, CellStatus::range_folded);
}

TEST(PolarSweep, FlagsOfClutterFilterPowerAreNotSeen) {
    SweepPlan plan;
    plan.moment = level2::Moment::cfp;
    plan.code = [](int, int gate) { return static_cast<std::uint16_t>(gate % 16); };
    const Prepared prepared(plan);
    EXPECT_EQ(prepared.at_range(10.5, 16e3).status, CellStatus::not_seen);
    EXPECT_EQ(prepared.at_range(10.5, 23e3).status, CellStatus::not_seen);
    EXPECT_EQ(prepared.at_range(10.5, 24e3).status, CellStatus::value);
}

TEST(PolarSweep, ShorterRadialsEndEarlier) {
    Prepared prepared(SweepPlan{});
    prepared.volume.sweeps[0].moments[0].gate_counts[7] = 100;
    const PolarSweep sweep(prepared.volume.sweeps[0], prepared.chosen[0], model,
                           options(level2::Moment::ref));
    EXPECT_EQ(sweep.sample(7.5F, place_at(98e3)).status, CellStatus::value);
    EXPECT_EQ(sweep.sample(7.5F, place_at(101e3)).status, CellStatus::not_seen);
    EXPECT_EQ(sweep.sample(8.5F, place_at(101e3)).status, CellStatus::value);
}

TEST(PolarSweep, RadialsOfTwoGateGeometriesInOneSweep) {
    level2::Volume volume = make_volume({SweepPlan{}});
    level2::SweepMoment fine = volume.sweeps[0].moments[0];
    fine.gate_spacing_m = 250;
    for (std::size_t radial = 0; radial < 360; ++radial) {
        auto& counts = radial < 180 ? fine.gate_counts : volume.sweeps[0].moments[0].gate_counts;
        counts[radial] = 0;
    }
    for (std::size_t i = 0; i < fine.codes8.size(); ++i)
        fine.codes8[i] = static_cast<std::uint8_t>(ref_code(50));
    volume.sweeps[0].moments.push_back(fine);
    const auto chosen = choose_sweeps(volume, level2::Moment::ref, 0.475);
    const PolarSweep sweep(volume.sweeps[0], chosen[0], model, options(level2::Moment::ref));
    EXPECT_EQ(sweep.sample(90.5F, place_at(200e3)).value, 20);
    EXPECT_EQ(sweep.sample(270.5F, place_at(70e3)).value, 50);
    EXPECT_EQ(sweep.sample(270.5F, place_at(200e3)).status, CellStatus::not_seen);
}

TEST(PolarSweep, CountsThatPromiseMoreThanThereIsAreNotBelieved) {
    Prepared prepared(SweepPlan{});
    level2::SweepMoment& moment = prepared.volume.sweeps[0].moments[0];
    moment.codes8.resize(100 * 300);
    const PolarSweep sweep(prepared.volume.sweeps[0], prepared.chosen[0], model,
                           options(level2::Moment::ref));
    EXPECT_EQ(sweep.sample(99.5F, place_at(50e3)).status, CellStatus::value);
    EXPECT_EQ(sweep.sample(100.5F, place_at(50e3)).status, CellStatus::not_seen);
}

TEST(PolarSweep, TheGreatestArcIsThatOfTheLastGate) {
    const Prepared prepared(SweepPlan{});
    const double arc_m =
        greatest_arc_m(prepared.volume.sweeps[0], prepared.chosen[0], level2::Moment::ref, model);
    EXPECT_NEAR(arc_m, beam.forward({300e3, 0.5}).arc_m, 1);
}

// The edges of a beam over an arc, computed from the model without tables. An edge is present only
// if it is on its proper side of the beam's center.
struct Edges {
    bool lower = false, upper = false;
    bool operator==(const Edges&) const = default;
};

// In a duct, an edge may meet the ground before its beam does, or cross to the other side of the
// beam.
TEST(PolarSweep, ABeamThatLostAnEdgeRisesAsTheHalfThatIsThere) {
    const std::vector<RefractivityLevel> levels = {
        {0, 340}, {40, 338.4}, {190, 224.4}, {1000, 200}, {10000, 60}};
    const BeamModel traced =
        BeamModel::traced(35, 20, RefractivityProfile::from_levels(levels, "duct").value());
    int both = 0, lower_alone = 0, upper_alone = 0, neither = 0, gone = 0;
    for (const double elevation_deg : {-1.0, -0.3, 0.2, 0.5, 1.5}) {
        const Prepared prepared({.elevation_deg = elevation_deg});
        const PolarSweep sweep = sweep_of(prepared, traced);
        const double center_deg = prepared.chosen[0].elevation_deg;
        const BeamPath center = traced.path(center_deg);
        const BeamPath low = traced.path(center_deg - 0.475);
        const BeamPath high = traced.path(center_deg + 0.475);
        const auto edges_over = [&](double arc_m) {
            const double height_m = center.over(arc_m).height_m;
            return Edges{std::islessequal(low.over(arc_m).height_m, height_m),
                         std::isgreaterequal(high.over(arc_m).height_m, height_m)};
        };
        for (double node_m = 500; node_m < 400e3; node_m += 500) {
            const double arc_m = node_m + 170;
            const auto [range_m, height_m] = center.over(arc_m);
            const auto heights = sweep.beam().heights(place_at(arc_m));
            if (std::isnan(center.over(node_m + 500).height_m)) {
                EXPECT_GT(heights.center_m, highest_beam_m) << elevation_deg << ' ' << arc_m;
                ++gone;
                continue;
            }
            const Edges edges = edges_over(arc_m);
            const bool sure = edges == edges_over(node_m) && edges == edges_over(node_m + 500);
            if (!sure) continue;
            const double up = (high.over(arc_m).height_m - height_m) / 0.475;
            const double down = (height_m - low.over(arc_m).height_m) / 0.475;
            double rise = range_m / 57.29577951;  // a degree, if there is no edge
            if (edges.lower && edges.upper) rise = (up + down) / 2;
            if (edges.lower != edges.upper) rise = edges.lower ? down : up;
            ++(edges.lower ? (edges.upper ? both : lower_alone)
                           : (edges.upper ? upper_alone : neither));
            ASSERT_NEAR(sweep.beam().rise_m_per_deg(heights), rise, 1)
                << elevation_deg << ' ' << arc_m;
            const auto seen = sweep.beam().without_lost_edges(place_at(arc_m), heights);
            EXPECT_EQ(seen.center_m, heights.center_m);
            EXPECT_EQ(seen.lower_m, edges.lower ? heights.lower_m : heights.center_m);
            EXPECT_EQ(seen.upper_m, edges.upper ? heights.upper_m : heights.center_m);
        }
    }
    for (const int count : {both, lower_alone, upper_alone, neither, gone})
        EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace stormcellar::grid
