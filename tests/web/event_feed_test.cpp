// Tests which events a client of the event hub gets while real volumes come chunk by chunk.
#include "web/data/events/event_feed.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/pipeline/small_house.h"
#include "tests/testing/waiting.h"
#include "tests/web/served_volumes.h"
#include "web/doors/api/door.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;

// Reads a listener event by event, and keeps later events for the next call.
class Ear {
  public:
    explicit Ear(std::shared_ptr<EventHub::Listener> listener) : listener_(std::move(listener)) {}
    // Reads until an event of this type has come. Returns the data of all events up to it.
    std::vector<json> hear_until(std::string_view type) {
        std::vector<json> all;
        const bool has_come = testing::eventually([&] {
            text_ += listener_->read(1 << 20);
            for (std::size_t end; (end = text_.find("\n\n")) != std::string::npos;) {
                const std::size_t data = text_.find("data: ");
                if (data < end) all.push_back(json::parse(text_.substr(data + 6, end - data - 6)));
                text_.erase(0, end + 2);
                if (data < end && all.back()["type"] == type) return true;
            }
            return false;
        });
        EXPECT_TRUE(has_come) << "no " << type << " came";
        return all;
    }

  private:
    std::shared_ptr<EventHub::Listener> listener_;
    std::string text_;
};

// Ingests LDM's chunks of a volume of KLOT (2026-03-28) and makes living grids of them.
class GrowingKlot {
  public:
    GrowingKlot() {
        for (const auto& entry :
             fs::directory_iterator(*testing::data_directory() / "chunks/OPENRADAR_KLOT"))
            chunks_.push_back(entry.path());
        std::ranges::sort(chunks_);
        fs::create_directories(directory_ / "drop/KLOT");
        pipeline::IngestOptions options = pipeline::small_grid();
        options.moments = {level2::Moment::ref};
        options.living.scratch = directory_.path();
        options.living.chunk_grace = 0s;
        ingestor_.emplace(catalog_, store_, options);
    }
    // Takes the chunks [first, last).
    void take(std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < std::min(last, chunks_.size()); ++i) {
            const fs::path path = directory_ / "drop/KLOT" / chunks_[i].filename();
            fs::copy_file(chunks_[i], path);
            ASSERT_TRUE(ingestor_->ingest(path, false));
        }
    }
    [[nodiscard]] fs::path cache() const { return directory_ / "cache"; }
    [[nodiscard]] fs::path catalog() const { return directory_ / "catalog"; }
    [[nodiscard]] std::size_t count() const { return chunks_.size(); }

  private:
    testing::TemporaryDirectory directory_;
    catalog::CatalogWriter catalog_ = *catalog::CatalogWriter::open(directory_ / "catalog");
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
    std::optional<pipeline::Ingestor> ingestor_;
    std::vector<fs::path> chunks_;
};

TEST(EventFeed, FollowsAVolumeFromItsFirstSweepToItsEnd) {
    STORMCELLAR_NEED_DATA();
    GrowingKlot klot;
    const auto hub = EventHub::make();
    const auto grids = *Grids::open({.cache = klot.cache()});
    const auto feed = EventFeed::open(
        {.grids = grids, .catalog = klot.catalog(), .hub = hub, .look_every = 20ms});
    Ear ear(hub->listen({.stations = {"KLOT"}}));
    klot.take(0, klot.count() / 2);
    auto all = ear.hear_until("sweep_gridded");
    klot.take(klot.count() / 2, klot.count());
    const auto rest = ear.hear_until("volume_complete");
    all.insert(all.end(), rest.begin(), rest.end());

    std::vector<json> begun, sweeps;
    for (const json& event : all) {
        EXPECT_EQ(event["station"], "KLOT");
        if (event["type"] == "volume_begun") begun.push_back(event);
        if (event["type"] == "sweep_gridded") sweeps.push_back(event);
    }
    ASSERT_EQ(begun.size(), 1u);
    EXPECT_EQ(begun[0]["volume"], "2026-03-28T20:14:57.447Z");
    ASSERT_GT(sweeps.size(), 1u)
        << "chunks come so fast here that one event may report several sweeps";
    for (std::size_t i = 1; i < sweeps.size(); ++i) {
        EXPECT_GT(sweeps[i]["sweeps"], sweeps[i - 1]["sweeps"]);
        EXPECT_GE(sweeps[i]["data_to"], sweeps[i - 1]["data_to"]) << "a sweep may have no REF";
        EXPECT_GE(sweeps[i]["newest_sweep"]["start"], sweeps[i - 1]["newest_sweep"]["start"]);
    }
    const json& complete = all.back();
    EXPECT_EQ(complete["partial"], false);
    EXPECT_EQ(complete["grid"], begun[0]["volume"]);
    EXPECT_EQ(complete["id"], (*grids->find("KLOT", level2::Moment::ref,
                                            grids->times("KLOT", level2::Moment::ref).at(0)))
                                  ->id);
    EXPECT_EQ(feed->unreadable(), 0u);
    ASSERT_EQ(feed->stations().size(), 1u);
    EXPECT_EQ(json(format_utc(*feed->stations()[0].newest_volume)), begun[0]["volume"]);
}

// If a server has no cache, events come from the catalog.
TEST(EventFeed, WithoutGridsTheCatalogTellsOfVolumes) {
    STORMCELLAR_NEED_DATA();
    ServedVolumes served(false);
    const auto hub = EventHub::make();
    const auto feed = EventFeed::open({.grids = nullptr,
                                       .catalog = served.state() / "catalog",
                                       .hub = hub,
                                       .silent_after = 1s,
                                       .look_every = 20ms});
    Ear ear(hub->listen({}));
    served.take(*testing::data_directory() / "volumes/KTLX20170101_030027_V06",
                "KTLX20170101_030027_V06");
    auto all = ear.hear_until("volume_complete");
    ASSERT_FALSE(all.empty());
    ASSERT_EQ(all.back()["type"], "volume_complete");
    const auto begun = std::find_if(
        all.begin(), all.end(), [](const json& event) { return event["type"] == "volume_begun"; });
    ASSERT_NE(begun, all.end());
    EXPECT_EQ((*begun)["station"], "KTLX");
    EXPECT_EQ(all.back()["volume"], (*begun)["volume"]);
    EXPECT_EQ(all.back()["partial"], false);
    EXPECT_GT(all.back()["sweeps"], 5);
    // On a busy machine the station is silent before its volume is complete.
    const auto tells_silence = [](const json& event) { return event["type"] == "station_silent"; };
    auto silent = std::ranges::find_if(all, tells_silence);
    if (silent == all.end()) {
        all = ear.hear_until("station_silent");
        silent = std::ranges::find_if(all, tells_silence);
    }
    ASSERT_NE(silent, all.end());
    EXPECT_EQ((*silent)["station"], "KTLX");
}

// 2026-11-28: a page that was opened after a radar fell silent did not learn of the silence.
TEST(EventFeed, TheListOfStationsSaysWhoIsSilent) {
    STORMCELLAR_NEED_DATA();
    for (const bool is_silent : {false, true}) {
        const std::shared_ptr<const EventFeed> feed =
            EventFeed::open({.grids = nullptr,
                             .catalog = served_volumes().state() / "catalog",
                             .hub = EventHub::make(),
                             .silent_after = is_silent ? -1s : 3600s});
        ApiDoor door(ApiSources{.grids = nullptr,
                                .catalog = served_volumes().state() / "catalog",
                                .kept = nullptr,
                                .feed = feed});
        for (const json& station :
             json::parse(body_of(asked(door, "/api/v1/stations")))["stations"])
            EXPECT_EQ(station["silent_s"].is_number(), is_silent) << station;
    }
}

TEST(EventFeed, WhatIsThereWhenItBeginsIsNotTold) {
    STORMCELLAR_NEED_DATA();
    const auto hub = EventHub::make();
    const auto feed = EventFeed::open({.grids = nullptr,
                                       .catalog = served_volumes().state() / "catalog",
                                       .hub = hub,
                                       .look_every = 5ms});
    ASSERT_TRUE(testing::eventually([&] { return feed->looks() >= 5; }));
    EXPECT_EQ(hub->published(), 0u);
    const auto pages = feed->stations();
    ASSERT_GE(pages.size(), 2u);
    EXPECT_EQ(pages[0].station, "KABR");
    EXPECT_FALSE(pages[0].is_silent);
}

}  // namespace
}  // namespace stormcellar::web
