#include "daemon/status/station_book.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/daemon/fake_sink.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestOutcome;
using pipeline::IngestResult;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;

const UtcTime volume_start =
    *parse_utc("2022-03-17T00:08:42Z", UtcTime{});  // of outcome_of()'s volume

IngestOutcome gridded(UtcTime volume, UtcTime newest_radial) {
    IngestOutcome outcome = outcome_of(IngestResult::gridded);
    outcome.volume_time = volume;
    outcome.newest_radial = newest_radial;
    return outcome;
}

TEST(Timings, CountAllAndSummariseTheLast) {
    Timings timings(100);
    EXPECT_EQ(timings.summary().count, 0U);
    for (int i = 1; i <= 250; ++i)
        timings.add(i);
    EXPECT_EQ(timings.count(), 250U);
    EXPECT_DOUBLE_EQ(timings.sum_s(), 125 * 251);
    const LatencySummary last = timings.summary();  // of 151 to 250
    EXPECT_EQ(last.count, 100U);
    EXPECT_EQ(last.median, 200);
    EXPECT_EQ(last.p95, 245);
    EXPECT_EQ(last.max, 250);
}

TEST(StationBook, KeepsTheNewestVolumeWhateverComesLater) {
    StationBook book;
    book.add(gridded(volume_start, volume_start + minutes{4}), 0.5, volume_start + minutes{5});
    book.add(gridded(volume_start - hours{3}, volume_start - hours{3}), std::nullopt,
             volume_start + minutes{6});
    const StationState& state = book.stations().at("KTLX");
    EXPECT_EQ(state.volume_time, volume_start);
    EXPECT_EQ(state.newest_radial, volume_start + minutes{4});
    EXPECT_EQ(state.ingested_at, volume_start + minutes{6});
    EXPECT_EQ(state.results.at(index_of(IngestResult::gridded)), 2U);
    EXPECT_EQ(state.close_to_cache.count(), 1U);
}

// Data of growing volumes count, although no volume is gridded yet. So the feed does not look
// silent.
TEST(StationBook, AGrowingVolumesChunksAreDataAndItsSweepsHaveTimes) {
    StationBook book;
    IngestOutcome chunk = outcome_of(IngestResult::incomplete);
    book.add(chunk, 0.1, volume_start + seconds{10});
    const StationState& state = book.stations().at("KTLX");
    EXPECT_EQ(state.data_at, volume_start + seconds{10});
    EXPECT_EQ(state.living, 0U);
    EXPECT_EQ(state.close_to_living.count(), 0U) << "this file completed no sweep";
    chunk.living = {"/c/living.scg"};
    book.add(chunk, 0.3, volume_start + seconds{15});
    chunk.ending = ending_of(IngestResult::registered);  // one file a chunk
    book.add(chunk, std::nullopt, volume_start + seconds{20});
    EXPECT_EQ(state.data_at, volume_start + seconds{20});
    EXPECT_EQ(state.living, 2U);
    EXPECT_EQ(state.close_to_living.count(), 1U) << "nobody saw the close of the other file";
    EXPECT_DOUBLE_EQ(state.close_to_living.sum_s(), 0.3);
    EXPECT_EQ(state.close_to_cache.count(), 0U);
    EXPECT_FALSE(state.ingested_at);
}

TEST(StationBook, AVolumeOfTheFutureHidesNothing) {
    StationBook book;
    book.add(gridded(volume_start, volume_start), std::nullopt, volume_start + minutes{1});
    book.add(gridded(volume_start + hours{24}, volume_start + hours{24}), std::nullopt,
             volume_start + minutes{2});
    EXPECT_EQ(book.stations().at("KTLX").volume_time, volume_start);
    EXPECT_EQ(book.stations().at("KTLX").newest_radial, volume_start);
    EXPECT_EQ(book.stations().at("KTLX").not_live, 1U);
}

TEST(StationBook, ReplayedDataAreCountedApartFromTheTimings) {
    StationBook book;
    book.add(gridded(volume_start, volume_start), std::nullopt, volume_start + seconds{42});
    book.add(gridded(volume_start, volume_start), std::nullopt, volume_start + hours{1});
    const StationState& state = book.stations().at("KTLX");
    EXPECT_EQ(state.antenna_to_cache.count(), 2U);
    EXPECT_EQ(state.antenna_to_cache.summary().median, 42);
    book.add(gridded(volume_start, volume_start), std::nullopt,
             volume_start + hours{1} + seconds{1});
    EXPECT_EQ(state.antenna_to_cache.count(), 2U);
    EXPECT_EQ(state.not_live, 1U);
    EXPECT_EQ(state.last_antenna_s, 3601) << "the book keeps the last number";
    EXPECT_FALSE(is_live(*state.last_antenna_s));
    EXPECT_TRUE(is_live(-600));
    EXPECT_FALSE(is_live(-601));
}

TEST(StationBook, EveryFileIsASignOfLifeAndOnlyGridsAreVolumes) {
    StationBook book;
    IngestOutcome waiting = outcome_of(IngestResult::incomplete);
    book.add(waiting, 0.1, volume_start);
    EXPECT_EQ(book.stations().at("KTLX").data_at, volume_start);
    EXPECT_FALSE(book.stations().at("KTLX").volume_time);
    EXPECT_FALSE(book.stations().at("KTLX").ingested_at);
    EXPECT_EQ(book.stations().at("KTLX").close_to_cache.count(), 0U);
    book.add_data("KTLX", volume_start + seconds{7});
    EXPECT_EQ(book.stations().at("KTLX").data_at, volume_start + seconds{7});
    waiting.station.clear();
    book.add(waiting, 0.1, volume_start);
    EXPECT_EQ(book.stations().size(), 1U) << "a file without a station must make no entry";
}

TEST(StationBook, AStationKnownBeforeTheStartHasAnAgeAndNothingElse) {
    StationBook book;
    book.add_known("KTLX", volume_start, volume_start + hours{5});
    book.add_known("KOUN", volume_start + hours{50}, volume_start);
    EXPECT_EQ(book.stations().at("KTLX").volume_time, volume_start);
    EXPECT_FALSE(book.stations().at("KTLX").data_at);
    book.add_known("KBGM", volume_start, volume_start + hours{7 * 24 + 1});
    book.add_known("", volume_start, volume_start);
    EXPECT_EQ(book.stations().size(), 1U)
        << "volumes of the future, old volumes and volumes of no station";
}

TEST(StationBook, MissingChunksAreSummedAndTheLastVolumesListed) {
    StationBook book;
    book.add_missing_chunks("KTLX", {volume_start, 17, {}, 0});
    EXPECT_TRUE(book.stations().at("KTLX").missing.empty());
    for (int volume = 0; volume < 20; ++volume)
        book.add_missing_chunks("KTLX", {volume_start, volume, {3, 9}, 0});
    const StationState& state = book.stations().at("KTLX");
    EXPECT_EQ(state.missing_chunks, 40U);
    ASSERT_EQ(state.missing.size(), 8U);
    EXPECT_EQ(state.missing.front().volume_number, 12);
    EXPECT_EQ(state.missing.back().numbers, (std::vector<int>{3, 9}));
    std::vector<int> many(1000);
    std::iota(many.begin(), many.end(), 1);
    book.add_missing_chunks("KTLX", {volume_start, 20, many, 0});
    EXPECT_EQ(state.missing.back().count, 1000U);
    EXPECT_EQ(state.missing.back().numbers.size(), 64U);
    EXPECT_EQ(state.missing_chunks, 1040U);
}

TEST(StationBook, StationsBeyondTheLimitAreCountedOnly) {
    StationBook book;
    for (std::size_t i = 0; i < StationBook::most_stations + 100; ++i)
        book.add_data("S" + std::to_string(i), volume_start);
    EXPECT_EQ(book.stations().size(), StationBook::most_stations);
    EXPECT_EQ(book.left_out(), 100U);
    book.add_data("S0", volume_start + seconds{1});
    EXPECT_EQ(book.stations().at("S0").data_at, volume_start + seconds{1})
        << "a known station stays";
    EXPECT_EQ(book.left_out(), 100U);
}

}  // namespace
}  // namespace stormcellar::daemon
