// Tests which fields and axes result from which gates.
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
    const auto layout = lay_out(volume);
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
    const auto layout = lay_out(volume);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range", "VEL on range_2", "SW on range_2"));
    EXPECT_EQ(layout->axes.at(0).gates, 2U);
    EXPECT_EQ(layout->axes.at(1).gates, 8U);
}

TEST(CfradialLayout, TheKindThatMostRadialsHaveTakesThePlainName) {
    const auto volume =
        small_volume({small_sweep(1, {at_1km(small_moment(Moment::ref, {{2}, {3}}))}),
                      small_sweep(2, {small_moment(Moment::ref, {{2}, {3}, {4}})})});
    const auto layout = lay_out(volume);
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
    const auto layout = lay_out(volume);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout),
                ElementsAre("VEL on range", "VEL_2 on range", "VEL_3 on range", "VEL_4 on range"));
}

TEST(CfradialLayout, ASweepThatHoldsOneKindTwiceLosesNeither) {
    const SweepMoment first = small_moment(Moment::ref, {{2}, {3}});
    const SweepMoment again = small_moment(Moment::ref, {{4}, {5}});
    const auto volume = small_volume({small_sweep(1, {first, again})});
    const auto layout = lay_out(volume);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range", "REF_2 on range"));
}

TEST(CfradialLayout, AScaleThatIsNoNumberIsOneScale) {
    SweepMoment odd = small_moment(Moment::ref, {{2}});
    odd.scale = std::numeric_limits<float>::quiet_NaN();
    const auto volume = small_volume({small_sweep(1, {odd}), small_sweep(2, {odd})});
    const auto layout = lay_out(volume);
    ASSERT_TRUE(layout);
    EXPECT_THAT(names(*layout), ElementsAre("REF on range"));
}

TEST(CfradialLayout, WhatHasNoGatesIsNoField) {
    const auto volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{}, {}})})});
    const auto layout = lay_out(volume);
    ASSERT_TRUE(layout);
    EXPECT_TRUE(layout->fields.empty());
    ASSERT_EQ(layout->axes.size(), 1U);
    EXPECT_EQ(layout->axes[0].gates, 0U);
    EXPECT_EQ(layout->radials, 2U);
}

TEST(CfradialLayout, RefusesWhatDoesNotFitItself) {
    const auto refused = [](auto spoil) {
        auto volume = small_volume({small_sweep(1, {small_moment(Moment::ref, {{2, 3}, {4}})})});
        EXPECT_TRUE(lay_out(volume));
        spoil(volume.sweeps[0]);
        const auto layout = lay_out(volume);
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

TEST(CfradialLayout, MoreKindsThanAnyRadarHasAreADamagedFile) {
    std::vector<level2::Sweep> sweeps;
    const auto add = [&] {
        SweepMoment moment = small_moment(Moment::ref, {{2}});
        moment.gate_spacing_m = static_cast<std::int32_t>(100 + sweeps.size());
        sweeps.push_back(small_sweep(static_cast<int>(sweeps.size() + 1), {moment}));
    };
    while (sweeps.size() < most_cfradial_fields)
        add();
    EXPECT_TRUE(lay_out(small_volume(sweeps)));
    add();
    const auto layout = lay_out(small_volume(sweeps));
    ASSERT_FALSE(layout);
    EXPECT_EQ(layout.error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace stormcellar::netcdf
