#include "grid/polar_sweep.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

const BeamGeometry beam(35, 390);

ArcPlace place_at(double arc_m) {
    const double along = arc_m / ArcTable::step_m;
    const auto index = static_cast<std::size_t>(along);
    return {index, static_cast<float>(along - static_cast<double>(index))};
}

struct Prepared {
    explicit Prepared(const SweepPlan& plan, double half_beam_deg = 0.475)
        : volume(make_volume({plan})),
          chosen(choose_sweeps(volume, plan.moment, half_beam_deg)),
          sweep(volume.sweeps[0], chosen[0], beam, {plan.moment, half_beam_deg, false, 1001}) {}
    [[nodiscard]] Sample at(double azimuth_deg, double arc_m) const {
        return sweep.sample(static_cast<float>(azimuth_deg), place_at(arc_m));
    }
    // Straight above this range.
    [[nodiscard]] Sample at_range(double azimuth_deg, double range_m) const {
        return at(azimuth_deg, beam.forward({range_m, chosen[0].elevation_deg}).arc_m);
    }
    level2::Volume volume;
    std::vector<ChosenSweep> chosen;
    PolarSweep sweep;
};

TEST(PolarSweep, TablesAreWithin15CentimetresOfTheModel) {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> arc(0, 499e3);
    for (const double elevation_deg : {-4.0, -0.5, 0.0, 0.5, 4.3, 19.5, 45.0, 60.0}) {
        SweepPlan plan;
        plan.elevation_deg = elevation_deg;
        // Gate numbers at 250 m, so that a gate's fraction tells the range.
        plan.gate_spacing_m = 250;
        const Prepared prepared(plan);
        for (int i = 0; i < 5000; ++i) {
            const double arc_m = arc(random);
            const auto exact = beam.over(arc_m, prepared.chosen[0].elevation_deg);
            const auto low = beam.over(arc_m, prepared.chosen[0].elevation_deg - 0.475);
            const auto high = beam.over(arc_m, prepared.chosen[0].elevation_deg + 0.475);
            const ArcPlace place = place_at(arc_m);
            ASSERT_NEAR(prepared.sweep.beam_height_m(place), exact.height_m, 0.15);
            ASSERT_NEAR(prepared.sweep.lower_edge_m(place), low.height_m, 0.15);
            ASSERT_NEAR(prepared.sweep.upper_edge_m(place), high.height_m, 0.15);
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

TEST(PolarSweep, GatesAtNegativeRangeAreDropped) {
    SweepPlan plan;
    plan.first_gate_m = -375;
    plan.gate_spacing_m = 250;
    plan.code = [](int, int gate) { return ref_code(gate); };
    const Prepared prepared(plan);
    EXPECT_EQ(prepared.at_range(10.5, 0).status, CellStatus::value);
    EXPECT_EQ(prepared.at_range(10.5, 0).value, 2) << "at 125 m, not the one at -125 m";
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
    EXPECT_NEAR(prepared.at(0.5, 50e3).limit_dbz, -7.5, 0.1);
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
    const PolarSweep sweep(prepared.volume.sweeps[0], prepared.chosen[0], beam,
                           {level2::Moment::ref, 0.475, false, 1001});
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
    const PolarSweep sweep(volume.sweeps[0], chosen[0], beam,
                           {level2::Moment::ref, 0.475, false, 1001});
    EXPECT_EQ(sweep.sample(90.5F, place_at(200e3)).value, 20);
    EXPECT_EQ(sweep.sample(270.5F, place_at(70e3)).value, 50);
    EXPECT_EQ(sweep.sample(270.5F, place_at(200e3)).status, CellStatus::not_seen);
}

TEST(PolarSweep, CountsThatPromiseMoreThanThereIsAreNotBelieved) {
    Prepared prepared(SweepPlan{});
    level2::SweepMoment& moment = prepared.volume.sweeps[0].moments[0];
    moment.codes8.resize(100 * 300);
    const PolarSweep sweep(prepared.volume.sweeps[0], prepared.chosen[0], beam,
                           {level2::Moment::ref, 0.475, false, 1001});
    EXPECT_EQ(sweep.sample(99.5F, place_at(50e3)).status, CellStatus::value);
    EXPECT_EQ(sweep.sample(100.5F, place_at(50e3)).status, CellStatus::not_seen);
}

TEST(PolarSweep, TheGreatestArcIsThatOfTheLastGate) {
    const Prepared prepared(SweepPlan{});
    const double arc_m =
        greatest_arc_m(prepared.volume.sweeps[0], prepared.chosen[0], level2::Moment::ref, beam);
    EXPECT_NEAR(arc_m, beam.forward({300e3, 0.5}).arc_m, 1);
}

}  // namespace
}  // namespace stormcellar::grid
