#include "stormcellar/level2/volume.h"

#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {
namespace {

SweepMoment two_radials(Moment moment) {
    SweepMoment m;
    m.moment = moment;
    m.gate_stride = 3;
    m.scale = 2;
    m.offset = 66;
    m.gate_counts = {3, 2};
    m.codes8 = {0, 1, 66, 7, 8, 0};
    return m;
}

TEST(MomentNames, RoundTrip) {
    for (const Moment moment : all_moments) {
        EXPECT_EQ(moment_from_name(moment_name(moment)), moment);
        EXPECT_FALSE(moment_units(moment).empty());
    }
    EXPECT_EQ(moment_from_name("ref"), std::nullopt);
    EXPECT_EQ(moment_from_name(""), std::nullopt);
}

TEST(SweepMoment, CodesZeroAndOneAreNotValues) {
    const SweepMoment m = two_radials(Moment::ref);
    EXPECT_EQ(m.status(0, 0), GateStatus::below_threshold);
    EXPECT_EQ(m.status(0, 1), GateStatus::range_folded);
    EXPECT_EQ(m.status(0, 2), GateStatus::valid);
    EXPECT_EQ(m.value_of(m.code(0, 2)), 0.0F);
}

TEST(SweepMoment, ClutterFilterPowerHasEightFlagCodes) {
    const SweepMoment m = two_radials(Moment::cfp);
    EXPECT_EQ(m.status(0, 1), GateStatus::no_data);
    EXPECT_EQ(m.status(1, 0), GateStatus::no_data);
    EXPECT_EQ(m.status(1, 1), GateStatus::valid);
}

TEST(SweepMoment, GatesOutsideTheRadialHoldNoData) {
    const SweepMoment m = two_radials(Moment::ref);
    EXPECT_EQ(m.status(1, 2), GateStatus::no_data) << "the radial is shorter";
    EXPECT_EQ(m.status(0, 3), GateStatus::no_data);
    EXPECT_EQ(m.status(0, -1), GateStatus::no_data);
    EXPECT_EQ(m.status(2, 0), GateStatus::no_data);
}

TEST(SweepMoment, ScaleZeroMeansThatTheCodeIsTheValue) {
    SweepMoment m = two_radials(Moment::ref);
    m.scale = 0;
    EXPECT_EQ(m.value_of(200), 200.0F);
}

TEST(Sweep, MeanElevationOfNothingIsNotANumber) {
    EXPECT_TRUE(std::isnan(Sweep{}.mean_elevation_deg()));
    Sweep sweep;
    sweep.radials.resize(2);
    sweep.radials[0].elevation_deg = -1.0F;
    sweep.radials[1].elevation_deg = 0.5F;
    EXPECT_DOUBLE_EQ(sweep.mean_elevation_deg(), -0.25);
}

TEST(VolumeHeader, NumberAfterTheDot) {
    VolumeHeader header;
    header.filename = "AR2V0006.116";
    EXPECT_EQ(header.volume_number(), 116);
    header.filename = "ARCHIVE2.000";
    EXPECT_EQ(header.volume_number(), 0);
    for (const char* bad : {"AR2V0006.", "AR2V0006", "AR2V0006.1x", "AR2V0006.-12", ""}) {
        header.filename = bad;
        EXPECT_EQ(header.volume_number(), std::nullopt) << bad;
    }
}

TEST(Volume, StartsAtTheHeadersTimeElseAtTheFirstRadial) {
    Volume volume;
    EXPECT_EQ(volume.start_time(), std::nullopt);
    volume.sweeps.resize(1);
    volume.sweeps[0].radials.resize(1);
    volume.sweeps[0].radials[0].time = time_from_nexrad(19069, 600000);
    EXPECT_EQ(volume.start_time(), time_from_nexrad(19069, 600000));
    volume.header = VolumeHeader{"AR2V0006.116", 19069, 522596, "KLOT"};
    EXPECT_EQ(volume.start_time(), time_from_nexrad(19069, 522596));
    volume.header->date = 0;  // a header without a date
    EXPECT_EQ(volume.start_time(), time_from_nexrad(19069, 600000));
}

class AntennaPositionTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto station = find_station("KTLX");
        ASSERT_TRUE(station);
        station_ = *station;
        volume_.station = "KTLX";
        VolumeBlock block;
        block.latitude_deg = static_cast<float>(station_.latitude_deg);
        block.longitude_deg = static_cast<float>(station_.longitude_deg);
        block.site_height_m = static_cast<std::int16_t>(station_.antenna_altitude_m - 20);
        block.tower_height_m = 20;
        volume_.block = block;
    }
    Station station_;
    Volume volume_;
};

TEST_F(AntennaPositionTest, IsSiteHeightPlusTowerHeight) {
    const auto position = antenna_position(volume_);
    ASSERT_TRUE(position);
    EXPECT_EQ(position->altitude_m, volume_.block->site_height_m + volume_.block->tower_height_m);
    EXPECT_FALSE(position->from_table);
    EXPECT_EQ(position->disagreement, std::nullopt);
}

TEST_F(AntennaPositionTest, EqualHeightsOfATdwrAreOneHeight) {
    volume_.station = "XXXX";
    volume_.block->site_height_m = 226;
    volume_.block->tower_height_m = 226;
    EXPECT_EQ(antenna_position(volume_)->altitude_m, 226);
}

TEST_F(AntennaPositionTest, TheTableWinsWhereAltitudesDifferByMoreThan30Metres) {
    volume_.block->site_height_m = static_cast<std::int16_t>(volume_.block->site_height_m - 100);
    const auto position = antenna_position(volume_);
    EXPECT_EQ(position->altitude_m, station_.antenna_altitude_m);
    EXPECT_TRUE(position->from_table);
    EXPECT_TRUE(position->disagreement);
}

TEST_F(AntennaPositionTest, AMovedSiteIsBelievedAndReported) {
    volume_.block->latitude_deg += 0.05F;
    const auto position = antenna_position(volume_);
    EXPECT_FLOAT_EQ(static_cast<float>(position->latitude_deg), volume_.block->latitude_deg);
    EXPECT_TRUE(position->disagreement);
}

TEST_F(AntennaPositionTest, ARadarThatIsElsewhereIsNotBelieved) {
    volume_.block->latitude_deg = -35;
    const auto position = antenna_position(volume_);
    EXPECT_EQ(position->latitude_deg, station_.latitude_deg);
    EXPECT_TRUE(position->from_table);
    EXPECT_TRUE(position->disagreement);
}

TEST_F(AntennaPositionTest, ThousandthsOfADegreeAreUnderstood) {
    volume_.block->latitude_deg *= 1000;
    volume_.block->longitude_deg *= 1000;
    const auto position = antenna_position(volume_);
    EXPECT_NEAR(position->latitude_deg, station_.latitude_deg, 1e-3);
    EXPECT_EQ(position->disagreement, std::nullopt);
}

TEST_F(AntennaPositionTest, NoPositionOrNonsenseTakesTheTable) {
    volume_.block->latitude_deg = std::nanf("");
    EXPECT_TRUE(antenna_position(volume_)->from_table);
    volume_.block->latitude_deg = 0;
    volume_.block->longitude_deg = 0;
    EXPECT_TRUE(antenna_position(volume_)->from_table);
    volume_.block.reset();
    EXPECT_TRUE(antenna_position(volume_)->from_table);
    volume_.station.clear();
    EXPECT_FALSE(antenna_position(volume_));
}

TEST(StartTime, IsTheHeadersUnlessItCannotBe) {
    const UtcTime first = time_from_nexrad(19069, 3'600'000);
    Volume volume;
    EXPECT_FALSE(volume.start_time());
    volume.header = VolumeHeader{"AR2V0006.001", 19069, 3'595'000, "KTLX"};
    EXPECT_EQ(volume.start_time(), first - std::chrono::seconds{5});
    volume.sweeps.resize(1);
    volume.sweeps[0].radials.resize(2);
    volume.sweeps[0].radials[0].time = time_from_nexrad(0, 0);  // no time
    volume.sweeps[0].radials[1].time = first;
    EXPECT_EQ(volume.start_time(), first - std::chrono::seconds{5});
    // One wrong bit in the day gives the year 2112 or years before there were radars.
    for (const std::uint32_t day : {19069U + 32768U, 0U, 2685U, 0xFFFFFFFFU}) {
        volume.header->date = day;
        EXPECT_EQ(volume.start_time(), first) << day;
    }
    volume.header.reset();
    EXPECT_EQ(volume.start_time(), first);
}

}  // namespace
}  // namespace stormcellar::level2
