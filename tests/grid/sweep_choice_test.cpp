#include "stormcellar/grid/sweep_choice.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/grid/real_volume.h"
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
    return SweepPlan{.elevation_deg = elevation_deg, .radials = radials, .gates = gates};
}

void set_vcp(level2::Volume& volume, const std::vector<float>& angles_deg) {
    level2::Vcp vcp;
    for (const float angle_deg : angles_deg) {
        level2::VcpCut cut{.elevation_deg = angle_deg};
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

// Cut number n of the volume maker begins n * 20 s after the start of the day and takes 18 s.
UtcTime at_s(double seconds) {
    return time_from_nexrad(19000, static_cast<std::uint32_t>(seconds * 1000));
}

TEST(ChooseSweeps, OfRepeatedCutsTheNearestInTimeCountsWhereATimeIsGiven) {
    auto volume = make_volume({plan(0.5), plan(1.4), plan(0.5), plan(2.4), plan(0.49)});
    for (std::size_t i = 0; i < volume.sweeps.size(); ++i) {
        for (level2::Radial& radial : volume.sweeps[i].radials)
            radial.time += std::chrono::seconds(20 * i);  // medians at 29, 49, 69, 89 and 109 s
    }
    const auto at = [&](double seconds) {
        return choose_sweeps(volume, level2::Moment::ref, 0.475, at_s(seconds));
    };
    EXPECT_EQ(indices(at(0)), (std::vector<std::size_t>{0, 1, 3}));
    EXPECT_EQ(indices(at(48.99)), (std::vector<std::size_t>{0, 1, 3}));
    EXPECT_EQ(indices(at(49)), (std::vector<std::size_t>{2, 1, 3}))
        << "the later sweep is as near as the first";
    EXPECT_EQ(indices(at(88.9)), (std::vector<std::size_t>{2, 1, 3}));
    EXPECT_EQ(indices(at(1e5)), (std::vector<std::size_t>{4, 1, 3}));
    EXPECT_EQ(at(0)[0].median_time, at_s(29));
    EXPECT_EQ(at(0)[0].repeats, 3U);
    EXPECT_EQ(at(0)[1].repeats, 1U);
    for (level2::Radial& radial : volume.sweeps[0].radials)
        radial.time = UtcTime{} - std::chrono::hours(24);
    EXPECT_EQ(indices(at(0)), (std::vector<std::size_t>{2, 1, 3}))
        << "the first sweep has no times";
    for (const std::size_t other : {2U, 4U}) {
        for (level2::Radial& radial : volume.sweeps[other].radials)
            radial.time = UtcTime{} - std::chrono::hours(24);
    }
    EXPECT_EQ(indices(at(0)), (std::vector<std::size_t>{4, 1, 3}))
        << "without times, the newest sweep counts";
    EXPECT_EQ(at(0)[0].median_time, std::nullopt);
}

TEST(ChooseSweeps, TheNearestInTimeMustBeFitToo) {
    const auto volume = make_volume({plan(0.5, 300, 100), plan(0.5), plan(0.5, 200)});
    const auto chosen = choose_sweeps(volume, level2::Moment::ref, 0.475, at_s(0));
    EXPECT_EQ(indices(chosen), (std::vector<std::size_t>{1}));
    EXPECT_EQ(chosen[0].repeats, 1U);
}

// Regression of 2026-11-21: where gates end at a ceiling (KDMX and KCCX at 2.5 degrees), a Doppler
// sweep reaches 90 % as far as its surveillance sweep, and was chosen for reflectivity.
TEST(ChooseSweeps, ASplitCutGivesTheSurveillanceSweepThatReachesHardlyFarther) {
    auto volume = make_volume({plan(2.5, 330), plan(2.5, 298)});
    for (level2::Radial& radial : volume.sweeps[0].radials)
        radial.unambiguous_range_m = 466000;
    for (level2::Radial& radial : volume.sweeps[1].radials)
        radial.unambiguous_range_m = 336000;
    EXPECT_EQ(indices(choose(volume)), (std::vector<std::size_t>{0}));
    for (level2::Radial& radial : volume.sweeps[1].radials)
        radial.unambiguous_range_m = std::nanf("");
    EXPECT_EQ(indices(choose(volume)), (std::vector<std::size_t>{0}));
    for (level2::Sweep& sweep : volume.sweeps)
        sweep.moments[0].moment = level2::Moment::vel;
    const auto velocity = choose_sweeps(volume, level2::Moment::vel, 0.475);
    EXPECT_EQ(indices(velocity), (std::vector<std::size_t>{1}))
        << "the unambiguous range is ignored";
}

// The sweep chosen at each elevation for a moment. `surveillance` is true for sweeps without VEL.
struct RealChoice {
    std::vector<std::size_t> sweeps;
    std::vector<bool> surveillance;
};
RealChoice choose_of(const level2::Volume& volume, level2::Moment moment,
                     std::optional<UtcTime> near = std::nullopt) {
    RealChoice choice;
    for (const ChosenSweep& sweep : choose_sweeps(volume, moment, 0.475, near)) {
        choice.sweeps.push_back(sweep.sweep_index);
        choice.surveillance.push_back(volume.sweeps[sweep.sweep_index].find(level2::Moment::vel) ==
                                      nullptr);
    }
    return choice;
}

TEST(ChooseSweeps, EachMomentOfRealSplitCutsComesFromItsSweep) {
    STORMCELLAR_NEED_DATA();
    struct Case {
        const char* name;
        std::size_t split_cuts, elevations;
    };
    for (const auto& [name, split_cuts, elevations] :
         {Case{"KLOT20220317_000842_V06", 3, 9}, Case{"KDMX20250101_225441_V06", 3, 5},
          Case{"KCCX20130112_070503_V06.gz", 3, 5}, Case{"KTLX19990503_235621.gz", 2, 14}}) {
        const level2::Volume volume = real_volume(std::string("volumes/") + name);
        const RealChoice ref = choose_of(volume, level2::Moment::ref);
        const RealChoice vel = choose_of(volume, level2::Moment::vel);
        ASSERT_EQ(ref.sweeps.size(), elevations) << name;
        ASSERT_EQ(vel.sweeps.size(), elevations) << name;
        for (std::size_t at = 0; at < elevations; ++at) {
            EXPECT_EQ(ref.surveillance[at], at < split_cuts) << name << " " << at;
            EXPECT_FALSE(vel.surveillance[at]) << name << " " << at;
            EXPECT_EQ(vel.sweeps[at], ref.sweeps[at] + (at < split_cuts ? 1 : 0)) << name;
        }
    }
}

// VCP 212 with MRLE repeats 0.5 and 0.9 degrees in the middle of the volume.
TEST(ChooseSweeps, RepeatedCutsOfARealVolume) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume("chunks/L2D_230");
    const auto first = [](const std::vector<std::size_t>& sweeps) {
        return std::vector<std::size_t>(sweeps.begin(), sweeps.begin() + 3);
    };
    using Sweeps = std::vector<std::size_t>;
    using level2::Moment;
    EXPECT_EQ(first(choose_of(volume, Moment::ref).sweeps), (Sweeps{10, 12, 4}));
    EXPECT_EQ(first(choose_of(volume, Moment::zdr).sweeps), (Sweeps{10, 12, 4}));
    EXPECT_EQ(first(choose_of(volume, Moment::vel).sweeps), (Sweeps{11, 13, 5}));
    const auto start = volume.start_time();
    ASSERT_TRUE(start);
    EXPECT_EQ(first(choose_of(volume, Moment::ref, start).sweeps), (Sweeps{0, 2, 4}));
    EXPECT_EQ(first(choose_of(volume, Moment::vel, start).sweeps), (Sweeps{1, 3, 5}));
    // Just before and just after the middle between the two medians of a pair, different sweeps are
    // chosen.
    const auto pair = choose_sweeps(volume, Moment::ref, 0.475, start);
    const auto later = choose_sweeps(volume, Moment::ref, 0.475);
    EXPECT_EQ(pair[0].repeats, 2U);
    EXPECT_EQ(pair[2].repeats, 1U);
    const auto middle = *pair[0].median_time + (*later[0].median_time - *pair[0].median_time) / 2;
    const std::chrono::milliseconds step{2};
    EXPECT_EQ(choose_of(volume, Moment::ref, middle - step).sweeps[0], 0U);
    EXPECT_EQ(choose_of(volume, Moment::ref, middle + step).sweeps[0], 10U);
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
    volume.sweeps[1].vcp_elevation_deg = 19.5F;  // contradicts the measured elevations
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
    EXPECT_TRUE(choose(volume)[1].adjacent_to_next) << "without a VCP, all are adjacent";
    set_vcp(volume, {0.5F, 0.5F, 1.45F, 2.4F, 3.35F, 4.3F});
    EXPECT_TRUE(choose(volume)[0].adjacent_to_next);
    EXPECT_FALSE(choose(volume)[1].adjacent_to_next);
    EXPECT_TRUE(choose(volume)[2].adjacent_to_next) << "no sweep is above the highest";
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
    EXPECT_EQ(azimuth_spacing_deg(std::vector<float>{10, 100}, 1), 2) << "the spacing is at most 2";
    EXPECT_EQ(azimuth_spacing_deg(std::vector<float>{10, 10, 10}, 0), 1)
        << "the spacing is never zero";
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
