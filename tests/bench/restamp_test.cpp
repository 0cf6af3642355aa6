// Tests that a re-stamped volume has the new site and time and the same gates.
#include "bench/restamp.h"

#include <chrono>
#include <set>

#include <gtest/gtest.h>

#include "bench/mosaic_feed.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/encode.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::bench {
namespace {

using namespace std::chrono_literals;

// Returns the volume after it was re-stamped, written and read again.
level2::Decoded sent_by(const level2::Volume& source, const Station& station, UtcTime start) {
    level2::Volume stamped = source;
    restamp(stamped, station, start);
    const auto encoded = level2::encode(stamped);
    EXPECT_TRUE(encoded.has_value()) << encoded.error().message;
    auto decoded = level2::decode(encoded->joined());
    EXPECT_TRUE(decoded.has_value()) << decoded.error().message;
    return std::move(*decoded);
}

void expect_same_gates(const level2::Volume& a, const level2::Volume& b) {
    ASSERT_EQ(a.sweeps.size(), b.sweeps.size());
    for (std::size_t i = 0; i < a.sweeps.size(); ++i) {
        ASSERT_EQ(a.sweeps[i].moments.size(), b.sweeps[i].moments.size());
        for (std::size_t at = 0; at < a.sweeps[i].moments.size(); ++at) {
            const level2::SweepMoment& one = a.sweeps[i].moments[at];
            const level2::SweepMoment& other = b.sweeps[i].moments[at];
            EXPECT_EQ(one.moment, other.moment);
            EXPECT_EQ(one.first_gate_m, other.first_gate_m);
            EXPECT_EQ(one.gate_counts, other.gate_counts);
            EXPECT_EQ(one.codes8, other.codes8);
            EXPECT_EQ(one.codes16, other.codes16);
        }
    }
}

void expect_moved(const level2::Volume& from, const level2::Volume& to,
                  std::chrono::milliseconds by) {
    ASSERT_EQ(from.radial_count(), to.radial_count());
    for (std::size_t i = 0; i < from.sweeps.size(); ++i) {
        for (std::size_t at = 0; at < from.sweeps[i].radials.size(); ++at) {
            const level2::Radial& one = from.sweeps[i].radials[at];
            const level2::Radial& other = to.sweeps[i].radials[at];
            ASSERT_EQ(one.time + by, other.time) << "sweep " << i << " radial " << at;
            ASSERT_EQ(one.azimuth_deg, other.azimuth_deg);
            ASSERT_EQ(one.elevation_deg, other.elevation_deg);
        }
    }
}

// The parameter is a volume of each kind: message 31, message 1, simulated.
class EachKind : public ::testing::TestWithParam<const char*> {};

TEST_P(EachKind, HasTheSiteAndTheTimesAskedForAndTheSameGates) {
    STORMCELLAR_NEED_DATA();
    const auto source = feed_volume(GetParam(), *testing::data_directory());
    ASSERT_TRUE(source.has_value()) << source.error().message;
    const Station station = *find_station("KTLX");
    const UtcTime start = feed_start() + 3h + 7min + 12s + 345ms;
    const level2::Decoded sent = sent_by(*source, station, start);

    EXPECT_TRUE(sent.report.complete);
    for (const level2::Problem& problem : sent.report.problems)
        ADD_FAILURE() << problem.text();
    EXPECT_EQ(sent.volume.station, "KTLX");
    ASSERT_TRUE(sent.volume.header.has_value());
    EXPECT_EQ(sent.volume.header->icao, "KTLX");
    EXPECT_EQ(sent.volume.start_time(), start);
    const auto antenna = level2::antenna_position(sent.volume);
    ASSERT_TRUE(antenna.has_value());
    EXPECT_FALSE(antenna->disagreement.has_value());
    EXPECT_NEAR(antenna->latitude_deg, station.latitude_deg, 1e-5);
    EXPECT_NEAR(antenna->longitude_deg, station.longitude_deg, 1e-5);
    EXPECT_NEAR(antenna->altitude_m, station.antenna_altitude_m, 0.5);
    expect_same_gates(*source, sent.volume);
    expect_moved(*source, sent.volume, start - *source->start_time());
}

INSTANTIATE_TEST_SUITE_P(All, EachKind,
                         ::testing::Values("mosaic-northeast/KDOX20100911_012056_V04.gz",
                                           "sequence-kbgm/KBGM20050822_024414.gz", "simulated-3"));

// The heights of site and tower must differ, because a reader takes two equal heights for a single
// height that was sent twice.
TEST(Restamp, SplitsAnAltitudeIntoTwoHeightsThatAddUp) {
    level2::Volume volume;
    volume.block.emplace();
    Station station = *find_station("KTLX");
    for (const double altitude_m : {-5.0, 0.0, 39.4, 40.0, 41.0, 2500.0}) {
        station.antenna_altitude_m = altitude_m;
        restamp(volume, station, feed_start());
        EXPECT_NE(int{volume.block->site_height_m}, int{volume.block->tower_height_m});
        EXPECT_NEAR(volume.block->site_height_m + volume.block->tower_height_m, altitude_m, 0.5);
    }
}

TEST(MosaicFeed, HasAHundredSitesThatKeepTheirKindAndTimeWithMoreSites) {
    const auto sites = feed_sites(most_sites);
    ASSERT_EQ(sites.size(), 100U);
    const auto few = feed_of(10, "feed");
    const auto all = feed_of(most_sites, "feed");
    std::set<std::filesystem::path> files;
    for (const FeedVolume& volume : all)
        files.insert(volume.file);
    for (const FeedVolume& volume : few)
        EXPECT_TRUE(files.contains(volume.file)) << volume.file;
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end(),
                               [](const auto& a, const auto& b) { return a.start < b.start; }));
    EXPECT_LT(all.back().start, feed_start() + feed_length + 10min);
    EXPECT_EQ(feed_domain(most_sites).nx, 256);
    EXPECT_NEAR(feed_domain(most_sites).spacing_m, 15e3, 1.5e3);
}

TEST(MosaicFeed, MakesFilesOnceAndEachIsOfItsSiteAndTime) {
    STORMCELLAR_NEED_DATA();
    const testing::TemporaryDirectory work;
    const auto feed = work.path() / "feed";
    ASSERT_TRUE(make_feed(1, *testing::data_directory(), feed, 1).has_value());
    const auto volumes = feed_of(1, feed);
    ASSERT_EQ(volumes.size(), 30U);
    for (const FeedVolume& volume : volumes) {
        if (volume.moved > 0h) continue;
        const auto decoded = level2::decode_file(volume.file);
        ASSERT_TRUE(decoded.has_value()) << decoded.error().message;
        EXPECT_EQ(decoded->volume.station, feed_sites(1)[0].icao);
        EXPECT_EQ(decoded->volume.start_time(), volume.start);
    }
    const auto written = std::filesystem::last_write_time(volumes[0].file);
    ASSERT_TRUE(make_feed(1, *testing::data_directory(), feed, 1).has_value());
    EXPECT_EQ(std::filesystem::last_write_time(volumes[0].file), written);
}

TEST(MosaicFeed, SaysWhichRealVolumeIsMissing) {
    const testing::TemporaryDirectory empty;
    const Status made = make_feed(1, empty.path(), empty.path() / "feed", 1);
    ASSERT_FALSE(made.has_value());
    EXPECT_EQ(made.error().code, ErrorCode::not_found);
}

TEST(FeedSize, CountsBytesOfFilesThatExpandLittle) {
    FeedSize size;
    size.add(100, 800);
    size.add(100, 801);
    EXPECT_DOUBLE_EQ(size.expansion(), 8.005);
    EXPECT_DOUBLE_EQ(size.dense_part(), 800.0 / 1601);
}

}  // namespace
}  // namespace stormcellar::bench
