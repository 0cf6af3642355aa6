// Tests which fields and axes a file gets for the gates of a volume.
#include "export/cfradial_layout.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/export/small_volume.h"

namespace stormcellar::netcdf {
namespace {

using level2::Moment;
using level2::SweepMoment;
using ::testing::ElementsAre;

SweepMoment at_1km(SweepMoment moment) {
    moment.first_gate_m = 0;
    moment.gate_spacing_m = 1000;
    return moment;
}

std::vector<std::string> names(const CfradialLayout& layout) {
    std::vector<std::string> found;
    for (const CfradialField& field : layout.fields)
        found.push_back(field.name + " on " + layout.axes[field.axis].name);
    return found;
}

TEST(CfradialLayout, MomentsOfOneGeometryShareOneAxisAsLongAsTheLongestRadial) {
    const auto volume =
        small_volume({small_sweep(1, {small_moment(Moment::vel, {{2, 3}, {4}}),
                                      small_moment(Moment::ref, {{2, 3, 4}, {}})}),
                      small_sweep(2, {small_moment(Moment::ref, {{2, 3, 4, 5, 6}})})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::of_each_geometry);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range", "VEL on range"));
    EXPECT_EQ(layout->axes.at(0).gates, 5U);
    EXPECT_EQ(layout->axes.at(0).first_gate_m, 2125);
    EXPECT_EQ(layout->axes.at(0).gate_spacing_m, 250);
    EXPECT_THAT(layout->first_radials, ElementsAre(0U, 2U));
    EXPECT_EQ(layout->radials, 3U);
    EXPECT_EQ(layout->fields.at(0).radials, 2U);
    EXPECT_EQ(layout->fields.at(1).sweeps.at(1), nullptr) << "the second sweep has no VEL";
}

TEST(CfradialLayout, LegacyMomentsHaveAxesOfTheirOwn) {
    const auto volume =
        small_volume({small_sweep(1, {at_1km(small_moment(Moment::ref, {{2, 3}})),
                                      small_moment(Moment::vel, {{2, 3, 4, 5, 6, 7, 8, 9}}),
                                      small_moment(Moment::sw, {{2, 3, 4, 5, 6, 7, 8, 9}})})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::of_each_geometry);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range", "VEL on range_2", "SW on range_2"));
    EXPECT_EQ(layout->axes.at(0).gates, 2U);
    EXPECT_EQ(layout->axes.at(1).gates, 8U);
}

TEST(CfradialLayout, TheKindThatMostRadialsHaveTakesThePlainName) {
    const auto volume =
        small_volume({small_sweep(1, {at_1km(small_moment(Moment::ref, {{2}, {3}}))}),
                      small_sweep(2, {small_moment(Moment::ref, {{2}, {3}, {4}})})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::of_each_geometry);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range", "REF_2 on range_2"));
    EXPECT_EQ(layout->axes.at(0).gate_spacing_m, 250);
    EXPECT_EQ(layout->axes.at(1).gate_spacing_m, 1000);
}

TEST(CfradialLayout, ADifferenceInScaleOffsetOrWordSizeMakesAField) {
    std::vector<SweepMoment> kinds(4, small_moment(Moment::vel, {{2}, {}, {}, {}}));
    kinds[1].scale = 1;
    kinds[2].offset = 129;
    kinds[3] = wide_moment(Moment::vel, {{}, {}, {}, {2}});
    const auto volume = small_volume({small_sweep(1, kinds)});
    const auto layout = lay_out(volume.sweeps, RangeAxes::of_each_geometry);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout),
                ElementsAre("VEL on range", "VEL_2 on range", "VEL_3 on range", "VEL_4 on range"));
}

TEST(CfradialLayout, ASweepThatHoldsOneKindTwiceLosesNeither) {
    const SweepMoment first = small_moment(Moment::ref, {{2}, {3}});
    const SweepMoment again = small_moment(Moment::ref, {{4}, {5}});
    const auto volume = small_volume({small_sweep(1, {first, again})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::of_each_geometry);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range", "REF_2 on range"));
}

TEST(CfradialLayout, AScaleThatIsNoNumberIsOneScale) {
    SweepMoment odd = small_moment(Moment::ref, {{2}});
    odd.scale = std::numeric_limits<float>::quiet_NaN();
    const auto volume = small_volume({small_sweep(1, {odd}), small_sweep(2, {odd})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::of_each_geometry);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range"));
}

TEST(CfradialLayout, WhatHasNoGatesIsNoField) {
    const auto volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{}, {}})})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::of_each_geometry);
    ASSERT_TRUE(layout);
    EXPECT_TRUE(layout->fields.empty());
    ASSERT_EQ(layout->axes.size(), 1U);
    EXPECT_EQ(layout->axes[0].gates, 0U);
    EXPECT_EQ(layout->radials, 2U);
}

TEST(CfradialLayout, RefusesWhatDoesNotFitItself) {
    const auto refused = [](auto spoil) {
        auto volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2, 3}, {4}})})});
        EXPECT_TRUE(lay_out(volume.sweeps, RangeAxes::of_each_geometry));
        spoil(volume.sweeps[0]);
        const auto layout = lay_out(volume.sweeps, RangeAxes::of_each_geometry);
        return !layout && layout.error().code == ErrorCode::bad_argument;
    };
    using level2::Sweep;
    EXPECT_TRUE(refused([](Sweep& sweep) { sweep.radials.clear(); }));
    EXPECT_TRUE(refused([](Sweep& sweep) { sweep.radials.pop_back(); }));
    EXPECT_TRUE(refused([](Sweep& sweep) { sweep.moments[0].codes8.pop_back(); }));
    EXPECT_TRUE(refused([](Sweep& sweep) { sweep.moments[0].gate_counts[0] = 3; }));
    EXPECT_TRUE(refused([](Sweep& sweep) { sweep.moments[0].gate_stride = -2; }));
    EXPECT_TRUE(refused([](Sweep& sweep) { sweep.moments[0].word_size_bits = 16; }));
    EXPECT_TRUE(refused([](Sweep& sweep) { sweep.moments[0].word_size_bits = 12; }));
}

// 2026-11-28: Py-ART and xradar, which read one axis, saw no VEL of a volume before 2008.
TEST(CfradialLayout, OnOneAxisALegacyGateOfOneKilometerStandsFourTimes) {
    SweepMoment doppler = small_moment(Moment::vel, {{2, 3, 4, 5, 6, 7, 8, 9}});
    doppler.first_gate_m = -375;
    const auto volume =
        small_volume({small_sweep(1, {at_1km(small_moment(Moment::ref, {{2, 3, 4}})), doppler})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::one_if_possible);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range", "VEL on range"));
    ASSERT_EQ(layout->axes.size(), 1U);
    EXPECT_EQ(layout->axes[0].first_gate_m, -375);
    EXPECT_EQ(layout->axes[0].gate_spacing_m, 250);
    EXPECT_EQ(layout->axes[0].gates, 12U);
    const GatePlacement ref = place_gates(layout->axes[0], *layout->fields[0].sweeps[0]);
    EXPECT_EQ(ref.first, 0U) << "-500 to 500 m are the centers -375 to 375 m";
    EXPECT_EQ(ref.repeats, 4U);
    const GatePlacement vel = place_gates(layout->axes[0], *layout->fields[1].sweeps[0]);
    EXPECT_EQ(vel.first, 0U);
    EXPECT_EQ(vel.repeats, 1U);
}

// 2026-11-28: Py-ART and xradar found no values in the long sweep of a TDWR (300 m gates).
TEST(CfradialLayout, OnOneAxisAMomentOfTwoGateLengthsIsOneField) {
    SweepMoment far = small_moment(Moment::ref, {{2, 3, 4}});
    far.first_gate_m = 0;
    far.gate_spacing_m = 300;
    SweepMoment near = small_moment(Moment::ref, {{5, 6}});
    near.first_gate_m = 0;
    near.gate_spacing_m = 150;
    const auto volume = small_volume({small_sweep(1, {far}), small_sweep(2, {near})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::one_if_possible);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range"));
    EXPECT_EQ(layout->axes.at(0).gates, 6U);
    EXPECT_EQ(place_gates(layout->axes[0], far).repeats, 2U);
    EXPECT_EQ(place_gates(layout->axes[0], far).first, 0U) << "the gate ends at 150 m";
}

TEST(CfradialLayout, TheOneAxisBeginsWithTheNearestGate) {
    const SweepMoment doppler = small_moment(Moment::vel, {{2}});  // gates of 250 m from 2125 m
    SweepMoment ref = at_1km(small_moment(Moment::ref, {{2, 3}}));
    ref.first_gate_m = 1000;  // the first gate begins at 500 m
    const auto volume = small_volume({small_sweep(1, {ref, doppler})});
    const auto layout = lay_out(volume.sweeps, RangeAxes::one_if_possible);
    ASSERT_TRUE(layout);
    ASSERT_EQ(layout->axes.size(), 1U);
    EXPECT_EQ(layout->axes[0].first_gate_m, 625);
    EXPECT_EQ(place_gates(layout->axes[0], ref).first, 0U);
    EXPECT_EQ(place_gates(layout->axes[0], doppler).first, 6U);
    EXPECT_EQ(layout->axes[0].gates, 8U) << "the axis goes from 625 to 2375 m";
}

TEST(CfradialLayout, GatesThatNoAxisCanHoldHaveAxesOfTheirOwn) {
    const auto axes = [](std::int32_t first_gate_m, std::int32_t spacing_m) {
        SweepMoment odd = small_moment(Moment::vel, {{2}});
        odd.first_gate_m = first_gate_m;
        odd.gate_spacing_m = spacing_m;
        const auto volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2}}), odd})});
        const auto layout = lay_out(volume.sweeps, RangeAxes::one_if_possible);
        return layout ? layout->axes.size() : 0;
    };
    EXPECT_EQ(axes(2125, 500), 1U);
    EXPECT_EQ(axes(2375, 250), 1U) << "the gates begin one gate farther";
    EXPECT_EQ(axes(2000, 250), 2U) << "the gates begin half a gate nearer";
    EXPECT_EQ(axes(2125, 300), 2U) << "300 m is not a multiple of 250 m";
    EXPECT_EQ(axes(2125, 2250), 2U) << "2250 m is nine times 250 m";
    EXPECT_EQ(axes(2125, 0), 2U);
    EXPECT_EQ(axes(2125, -250), 2U);
    EXPECT_EQ(axes(2125 + 250 * 9000, 250), 2U) << "the gates begin thousands of gates away";
}

TEST(CfradialLayout, MoreKindsThanAnyRadarHasAreADamagedFile) {
    std::vector<level2::Sweep> sweeps;
    const auto add = [&] {
        SweepMoment moment = small_moment(Moment::ref, {{2}});
        moment.gate_spacing_m = static_cast<std::int32_t>(100 + sweeps.size());
        sweeps.push_back(small_sweep(static_cast<int>(sweeps.size() + 1), {moment}));
    };
    while (sweeps.size() < most_cfradial_fields)
        add();
    EXPECT_TRUE(lay_out(sweeps, RangeAxes::of_each_geometry));
    add();
    const auto layout = lay_out(sweeps, RangeAxes::of_each_geometry);
    ASSERT_FALSE(layout);
    EXPECT_EQ(layout.error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace stormcellar::netcdf
