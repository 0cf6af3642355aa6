#include "grid/sweep_choice.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

std::vector<std::size_t> indices(const std::vector<ChosenSweep>& chosen) {
    std::vector<std::size_t> list;
    list.reserve(chosen.size());
    for (const ChosenSweep& sweep : chosen)
        list.push_back(sweep.sweep_index);
    return list;
}

std::vector<ChosenSweep> choose(const level2::Volume& volume) {
    return choose_sweeps(volume, level2::Moment::ref, 0.475);
}

SweepPlan plan(double elevation_deg, int gates = 300, int radials = 360) {
    SweepPlan made;
    made.elevation_deg = elevation_deg;
    made.gates = gates;
    made.radials = radials;
    return made;
}

void set_vcp(level2::Volume& volume, const std::vector<float>& angles_deg) {
    level2::Vcp vcp;
    for (const float angle_deg : angles_deg) {
        level2::VcpCut cut;
        cut.elevation_deg = angle_deg;
        vcp.cuts.push_back(cut);
    }
    volume.vcp_message = vcp;
}

TEST(ChooseSweeps, OrdersByMeasuredElevation) {
    const auto volume = make_volume({plan(5), plan(0.5), plan(2)});
    EXPECT_EQ(indices(choose(volume)), (std::vector<std::size_t>{1, 2, 0}));
}

TEST(ChooseSweeps, ASplitCutGivesTheSweepThatReachesFarther) {
    const auto volume = make_volume({plan(0.5, 460), plan(0.52, 230), plan(1.4, 460)});
    EXPECT_EQ(indices(choose(volume)), (std::vector<std::size_t>{0, 2}));
}

TEST(ChooseSweeps, OfRepeatedCutsTheNewestCounts) {
    const auto volume = make_volume({plan(0.5), plan(1.4), plan(0.5), plan(2.4), plan(0.49)});
    EXPECT_EQ(indices(choose(volume)), (std::vector<std::size_t>{4, 1, 3}));
}

TEST(ChooseSweeps, ASweepThatBrokeOffDoesNotDisplaceAWholeOne) {
    const auto volume = make_volume({plan(0.5), plan(0.5, 300, 100)});
    EXPECT_EQ(indices(choose(volume)), (std::vector<std::size_t>{0}));
    const auto alone = make_volume({plan(0.5, 300, 100)});
    EXPECT_EQ(indices(choose(alone)), (std::vector<std::size_t>{0}));
}

TEST(ChooseSweeps, TheVcpsAngleTellsCutsApartWhenTheAntennaIsOff) {
    auto volume = make_volume({plan(0.45), plan(0.6)});
    EXPECT_EQ(choose(volume).size(), 1U);
    volume.sweeps[0].vcp_elevation_deg = 0.48F;
    volume.sweeps[1].vcp_elevation_deg = 0.88F;
    EXPECT_EQ(choose(volume).size(), 2U);
    volume.sweeps[1].vcp_elevation_deg = 19.5F;  // contradicts what was measured
    EXPECT_EQ(choose(volume).size(), 1U);
}

TEST(ChooseSweeps, RadialsOffTheElevationAreLeftOut) {
    auto volume = make_volume({plan(0.8)});
    for (std::size_t i = 0; i < 80; ++i)
        volume.sweeps[0].radials[i].elevation_deg = 20;
    volume.sweeps[0].radials[90].elevation_deg = 1.2F;
    const auto chosen = choose(volume);
    ASSERT_EQ(chosen.size(), 1U);
    EXPECT_NEAR(chosen[0].elevation_deg, 0.8, 1e-6);
    EXPECT_EQ(chosen[0].radials_off_elevation, 80U);
    EXPECT_EQ(chosen[0].radials.size(), 280U);
    EXPECT_EQ(chosen[0].radials.front(), 80U);
}

TEST(ChooseSweeps, RadialsWithoutTheMomentOrWithoutAnglesAreLeftOut) {
    auto volume = make_volume({plan(0.5)});
    volume.sweeps[0].moments[0].gate_counts[3] = 0;
    volume.sweeps[0].radials[4].azimuth_deg = std::nanf("");
    volume.sweeps[0].radials[5].elevation_deg = std::nanf("");
    volume.sweeps[0].radials[6].azimuth_deg = 1e9F;
    const auto chosen = choose(volume);
    ASSERT_EQ(chosen.size(), 1U);
    EXPECT_EQ(chosen[0].radials.size(), 356U);
    EXPECT_EQ(chosen[0].radials_off_elevation, 0U);
}

TEST(ChooseSweeps, NothingForAMomentThatIsNotThere) {
    const auto volume = make_volume({plan(0.5)});
    EXPECT_TRUE(choose_sweeps(volume, level2::Moment::vel, 0.475).empty());
    EXPECT_TRUE(choose(level2::Volume{}).empty());
}

TEST(ChooseSweeps, ALostCutIsNoticedByTheVcp) {
    auto volume = make_volume({plan(0.5), plan(1.45), plan(3.35)});
    EXPECT_TRUE(choose(volume)[1].adjacent_to_next) << "without a VCP neighbours are adjacent";
    set_vcp(volume, {0.5F, 0.5F, 1.45F, 2.4F, 3.35F, 4.3F});
    EXPECT_TRUE(choose(volume)[0].adjacent_to_next);
    EXPECT_FALSE(choose(volume)[1].adjacent_to_next);
    EXPECT_TRUE(choose(volume)[2].adjacent_to_next) << "nothing above the highest";
    set_vcp(volume, {0.5F, 1.45F, 3.35F, 4.3F});
    EXPECT_TRUE(choose(volume)[1].adjacent_to_next);
}

TEST(ChooseSweeps, ALostCutIsNoticedByTheNumberOfAnEarlyPattern) {
    auto volume = make_volume({plan(0.4), plan(1.35), plan(3.25)});
    volume.vcp = 21;
    const auto chosen = choose(volume);
    EXPECT_TRUE(chosen[0].adjacent_to_next);
    EXPECT_FALSE(chosen[1].adjacent_to_next);
    volume.vcp = 999;
    EXPECT_TRUE(vcp_angles_deg(volume).empty());
}

TEST(AzimuthSpacing, IsStatedOrMeasured) {
    std::vector<float> one_degree;
    one_degree.reserve(360);
    for (int i = 0; i < 360; ++i)
        one_degree.push_back(static_cast<float>(i));
    EXPECT_EQ(azimuth_spacing_deg(one_degree, 0), 1);
    EXPECT_EQ(azimuth_spacing_deg(one_degree, 0.5F), 1) << "half-degree radials would leave gaps";
    EXPECT_EQ(azimuth_spacing_deg(one_degree, 1), 1);
    EXPECT_EQ(azimuth_spacing_deg({}, 0), 1);
    EXPECT_EQ(azimuth_spacing_deg({}, 0.5F), 0.5);
    EXPECT_EQ(azimuth_spacing_deg(std::vector<float>{10, 100}, 1), 2) << "at most 2";
    EXPECT_EQ(azimuth_spacing_deg(std::vector<float>{10, 10, 10}, 0), 1) << "never zero";
}

TEST(NormalAzimuth, WrapsWhatIsNearAndRefusesTheRest) {
    EXPECT_EQ(normal_azimuth(0), 0.0F);
    EXPECT_EQ(normal_azimuth(360), 0.0F);
    EXPECT_EQ(normal_azimuth(-90), 270.0F);
    EXPECT_EQ(normal_azimuth(-1e-9F), 0.0F);
    EXPECT_EQ(normal_azimuth(725), std::nullopt);
    EXPECT_EQ(normal_azimuth(std::nanf("")), std::nullopt);
    EXPECT_EQ(normal_azimuth(HUGE_VALF), std::nullopt);
}

}  // namespace
}  // namespace stormcellar::grid
