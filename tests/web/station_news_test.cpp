// Tests when stations count as silent, speak again, and begin volumes.
#include "web/data/events/station_news.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/testing/temporary_directory.h"
#include "web/data/events/catalog_changes.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;
const UtcTime start = *parse_utc("2026-05-01T12:00", UtcTime{});

std::vector<std::string> names_of(const std::vector<Event>& events) {
    std::vector<std::string> names;
    for (const Event& event : events)
        names.emplace_back(event_name(event.type));
    return names;
}
using Names = std::vector<std::string>;

TEST(StationNews, AVolumeBeginsOnce) {
    StationNews book(20min);
    book.note("KTLX", start - 5min, start - 1min, start);
    const auto events = book.hear("KTLX", SeenVolume{start, 212}, start + 30s, start + 31s);
    ASSERT_EQ(names_of(events), Names{"volume_begun"});
    EXPECT_EQ(nlohmann::json::parse(events[0].json),
              nlohmann::json::parse(R"({"type": "volume_begun", "time": "2026-05-01T12:00:31Z",
                  "station": "KTLX", "volume": "2026-05-01T12:00:00Z", "vcp": 212})"));
    EXPECT_EQ(names_of(book.hear("KTLX", SeenVolume{start}, start + 1min, start + 1min)), Names{});
    EXPECT_EQ(names_of(book.hear("KTLX", SeenVolume{start + 8s}, start + 1min, start + 1min)),
              Names{})
        << "the same volume, named by the time of its first radial";
    EXPECT_EQ(names_of(book.hear("KTLX", SeenVolume{start - 5min}, start + 2min, start + 2min)),
              Names{})
        << "an old volume that came late";
    EXPECT_EQ(names_of(book.hear("KTLX", SeenVolume{start + 6min}, start + 7min, start + 7min)),
              Names{"volume_begun"});
}

TEST(StationNews, AVolumeOfTheFutureHidesNoOther) {
    StationNews book(20min);
    book.note("KTLX", start, start, start);
    EXPECT_EQ(names_of(book.hear("KTLX", SeenVolume{start + 24h}, start, start)), Names{});
    EXPECT_EQ(names_of(book.hear("KTLX", SeenVolume{start + 5min}, start + 5min, start + 5min)),
              Names{"volume_begun"});
}

TEST(StationNews, TellsOnceThatAStationIsSilentAndThatItSpeaks) {
    StationNews book(20min);
    book.note("KTLX", start, start, start);
    EXPECT_EQ(names_of(book.look(start + 20min)), Names{});
    const auto silent = book.look(start + 20min + 1500ms);
    ASSERT_EQ(names_of(silent), Names{"station_silent"});
    const auto json = nlohmann::json::parse(silent[0].json);
    EXPECT_EQ(json["silent_s"], 1201);
    EXPECT_EQ(json["newest_volume"], "2026-05-01T12:00:00Z");
    EXPECT_EQ(names_of(book.look(start + 25min)), Names{});
    EXPECT_TRUE(book.pages().at(0).is_silent);
    EXPECT_EQ(names_of(book.hear("KTLX", SeenVolume{start + 29min}, start + 30min, start + 30min)),
              (Names{"station_spoke", "volume_begun"}));
    EXPECT_FALSE(book.pages().at(0).is_silent);
}

// 2026-11-28: after a clock that was ahead had been set back, no station counted as silent for as
// long as the clock had been ahead.
TEST(StationNews, AClockThatIsSetBackHidesNoSilence) {
    StationNews book(20min);
    book.note("KTLX", std::nullopt, start + 2h, start + 2h);
    EXPECT_EQ(names_of(book.look(start)), Names{});
    EXPECT_EQ(names_of(book.look(start + 21min)), Names{"station_silent"});
}

TEST(StationNews, WhatWasSilentBeforeTheServerBeganIsNoNews) {
    StationNews book(20min);
    book.note("KTLX", start, start, start + 2h);
    book.note("KLOT", start, std::nullopt, start + 2h);
    EXPECT_EQ(names_of(book.look(start + 2h)), Names{});
    EXPECT_TRUE(book.pages().at(0).is_silent && book.pages().at(1).is_silent);
    EXPECT_EQ(names_of(book.hear("KLOT", std::nullopt, start + 1h, start + 2h)), Names{})
        << "data of an hour ago do not show that the station sends now";
}

// 2026-11-28: a station with grids alone counted as silent from the server's start to its first new
// grid, and no event reported the silence if no grid came.
TEST(StationNews, ANewVolumeSpeaksForAStationOfWhichNothingCameYet) {
    StationNews book(20min);
    book.note("KTLX", start, std::nullopt, start + 5min);
    EXPECT_FALSE(book.pages().at(0).is_silent);
    EXPECT_EQ(names_of(book.look(start + 20min + 1s)), Names{"station_silent"});
    EXPECT_EQ(book.pages().at(0).spoke(), start);
}

TEST(CatalogChanges, NamesTheStationsThatWereWritten) {
    const testing::TemporaryDirectory directory;
    CatalogChanges changes(directory.path());
    EXPECT_TRUE(changes.take().empty());
    const auto write = [&](const char* name) {
        std::ofstream(directory / name, std::ios::app) << "x";
    };
    for (const char* name :
         {"KTLX.sqlite", "KLOT.sqlite", "KLOT.sqlite-shm", "notes.sqlite", "KABR.sqlite-journal"})
        write(name);
    using Stations = std::vector<std::string>;
    EXPECT_EQ(changes.take(), (Stations{"KLOT", "KTLX"}));
    EXPECT_EQ(changes.take(), Stations{});
    write("KTLX.sqlite-wal");
    EXPECT_EQ(changes.take(), Stations{"KTLX"});
    write("KTLX.sqlite-wal");
    write("KLOT.sqlite");
    EXPECT_EQ(changes.take(), (Stations{"KLOT", "KTLX"}));
    std::filesystem::remove(directory / "KLOT.sqlite");
    EXPECT_EQ(changes.take(), Stations{});
    EXPECT_TRUE(CatalogChanges(directory / "nowhere").take().empty());
}

}  // namespace
}  // namespace stormcellar::web
