// Tests the national feed of bench_feed: re-stamped records, the files that its replay writes, and
// the growth of memory.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/feed_run.h"
#include "bench/grid_watch.h"
#include "bench/measure.h"
#include "bench/national_feed.h"
#include "bench/restamp.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/chunk_directory.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/volume_difference.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

Bytes real_file(const char* name) {
    return read_file(*testing::data_directory() / name).value();
}

// The reference is restamp(), which changes the decoded volume.
TEST(StampedRecords, AreWhatRestampMakesOfTheVolume) {
    STORMCELLAR_NEED_DATA();
    const Station station = *find_station("KMAF");
    const UtcTime start = national_start() + 3h + 345ms;
    for (const char* name :
         {"volumes/KLBB20160601_150025_V06", "volumes/KLOT20220317_000842_V06"}) {
        const Bytes file = real_file(name);
        const auto records = StampedRecords::read(file);
        ASSERT_TRUE(records) << records.error().message;
        auto expected = level2::decode(file).value().volume;
        restamp(expected, station, start);
        const Bytes stamped = records->stamped(station, start);
        const auto decoded = level2::decode(stamped);
        ASSERT_TRUE(decoded) << decoded.error().message;
        EXPECT_EQ(level2::difference(decoded->volume, expected), "") << name;
        EXPECT_TRUE(decoded->report.complete);
        EXPECT_NEAR(static_cast<double>(stamped.size()), static_cast<double>(file.size()),
                    0.01 * static_cast<double>(file.size()));
        EXPECT_GT(records->message_bytes(), 5 * file.size());
    }
}

TEST(StampedRecords, WhatIsNoneIsRefused) {
    EXPECT_FALSE(StampedRecords::read({}));
    EXPECT_FALSE(StampedRecords::read(Bytes(1000, std::byte{1})));
    STORMCELLAR_NEED_DATA();
    Bytes cut = real_file("volumes/KTLX20170101_030027_V06");
    EXPECT_TRUE(StampedRecords::read(cut));
    cut.resize(cut.size() - 100);
    EXPECT_FALSE(StampedRecords::read(cut));
}

// Returns a feed of eight sites. Their volumes are of all three kinds.
const NationalFeed& feed() {
    static const testing::TemporaryDirectory directory;
    static const NationalFeed made =
        NationalFeed::make(8, 1, *testing::data_directory(), directory.path(), 2).value();
    return made;
}

class PlayedFeed : public ::testing::TestWithParam<synth::Delivery> {
  protected:
    testing::TemporaryDirectory drop_;
};

// Writes, without pauses, all chunks that are due in the first 1.6 periods. Then stops the replay.
TEST_P(PlayedFeed, GivesEachVolumeAtItsTimeAsTheSiteWouldSendIt) {
    STORMCELLAR_NEED_DATA();
    const auto volumes = feed().volumes(2 * feed().period_s());
    std::vector<synth::ReplayItem> items;
    for (const NationalVolume& volume : volumes)
        items.push_back(feed().item_of(volume));
    std::atomic<bool> stop = false;
    std::set<std::size_t> ended;
    synth::ReplayOptions options;
    options.delivery = GetParam();
    options.past_s = feed().past_s() + 0.6 * feed().period_s();
    options.stop = &stop;
    options.stamp = [](const synth::ReplayItem& item, std::span<std::byte> bytes) {
        stamp_header_time(bytes, *item.time);
    };
    options.ended = [&](const synth::ReplayItem& item) {
        ended.insert(static_cast<std::size_t>(&item - items.data()));
    };
    options.begun = [&] { stop = true; };
    const auto report = synth::replay(items, drop_.path(), real_file_system(), options);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(ended.size(), report->files);
    std::size_t whole = 0;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const NationalSite& site = feed().sites()[volumes[i].site];
        const double start_s = site.first_start_s + volumes[i].number * feed().period_s();
        const double last_s =
            start_s + (GetParam() == synth::Delivery::whole
                           ? 0
                           : feed().period_s() * (1 - 1 / static_cast<double>(site.chunks)));
        EXPECT_EQ(ended.contains(i), last_s < 0.6 * feed().period_s()) << items[i].name;
        if (!ended.contains(i)) continue;
        ++whole;
        const std::string icao(site.station.icao);
        // Volumes of a station have numbers from 1 on.
        const fs::path path = GetParam() == synth::Delivery::chunks
                                  ? drop_ / icao / std::to_string(volumes[i].number + 1)
                                  : drop_ / items[i].name;
        const auto decoded = level2::decode_path(path);
        ASSERT_TRUE(decoded) << decoded.error().message;
        EXPECT_TRUE(decoded->report.complete);
        EXPECT_EQ(decoded->volume.station, icao);
        EXPECT_EQ(decoded->volume.start_time(), volumes[i].start)
            << "the header's time counts, though the radials have a different time";
        EXPECT_TRUE(volumes[i].grid.starts_with(icao + "_REF_" + format_compact(volumes[i].start)));
    }
    EXPECT_GE(whole, 4U);
}

INSTANTIATE_TEST_SUITE_P(Ways, PlayedFeed,
                         ::testing::Values(synth::Delivery::growing, synth::Delivery::open,
                                           synth::Delivery::whole, synth::Delivery::chunks));

TEST(NationalFeed, HasTheRateOfTheHeaviestHour) {
    STORMCELLAR_NEED_DATA();
    double bytes_a_second = 0;
    for (const NationalSite& site : feed().sites())
        bytes_a_second += static_cast<double>(site.bytes) / feed().period_s();
    EXPECT_NEAR(bytes_a_second * national_sites / 8 * 3600 / heaviest_hour_bytes, 1, 1e-9);
    EXPECT_NEAR(feed().chunks_a_second() * national_sites / 8, 33, 1);
    EXPECT_NEAR(feed().message_bytes_per_byte(), 7.1, 0.1);
}

TEST(FeedSoak, SlopeIsThatOfALineBehindTheFirstTenth) {
    std::vector<MemorySample> samples;
    for (int i = 0; i < 100; ++i) {
        const double seconds = 10.0 * i;
        samples.push_back({seconds, i < 10 ? 5000.0 * i : 100 + 2 * seconds / 3600});
    }
    EXPECT_NEAR(memory_slope_mib_h(samples), 2, 1e-9);
    EXPECT_TRUE(std::isnan(memory_slope_mib_h({})));
}

TEST(Quantile, IsByNearestRank) {
    EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
    std::vector<double> numbers;
    for (int i = 40; i >= 1; --i)
        numbers.push_back(i);
    EXPECT_EQ(quantile(numbers, 0.5), 20);
    EXPECT_EQ(quantile(numbers, 0.95), 38);
    EXPECT_EQ(quantile(numbers, 1), 40);
}

TEST(GridWatch, HearsOfFilesThatAreRenamedIntoPlace) {
    const testing::TemporaryDirectory cache;
    GridWatch watch;
    const std::vector<std::string> stations = {"KTLX"}, days = {"20240601"};
    ASSERT_TRUE(watch.watch(cache.path(), stations, days));
    const fs::path grid = cache / "KTLX/REF/20240601/KTLX_REF_20240601_000000_000.scg";
    ASSERT_TRUE(write_file_atomically(real_file_system(), grid, Bytes(3)));
    std::vector<std::string> heard;
    watch.read([&](std::string_view name) { heard.emplace_back(name); });
    EXPECT_THAT(heard, ::testing::ElementsAre(grid.filename().string()));
}

}  // namespace
}  // namespace stormcellar::bench
