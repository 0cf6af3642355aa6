// web/data/events/event_feed.h -- watches cache and catalog, and publishes what happens there.
//
// The daemon tells nobody what it does. The feed sees the grids that it renames into the cache
// (web/data/grids/cache_watch.h), the moment it does so, and looks every two seconds which
// stations' databases were written. Of a station that has grids of its own, these tell when a
// volume begins and ends; of any other, the catalog.
//
// Threads   Many threads may use it. One thread of its own reads and publishes.
// Errors    A catalog that is not there (yet) has no stations. What cannot be read is counted.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "stormcellar/catalog/catalog.h"
#include "web/data/events/event_hub.h"
#include "web/data/events/station_news.h"
#include "web/data/grids/grids.h"

namespace stormcellar::web {

struct EventFeedOptions {
    std::shared_ptr<Grids> grids;   // null: no cache
    std::filesystem::path catalog;  // empty: none
    // The same, if it is open already.
    std::shared_ptr<const catalog::CatalogReader> reader = nullptr;
    std::shared_ptr<EventHub> hub;
    std::chrono::seconds silent_after{1200};
    std::chrono::milliseconds look_every{2000};  // at the catalog
};

class EventFeed {
  public:
    // Begins. What is in cache and catalog at that moment is not told. It reads one row of each
    // station.
    static std::unique_ptr<EventFeed> open(EventFeedOptions options);
    EventFeed(const EventFeed&) = delete;
    EventFeed& operator=(const EventFeed&) = delete;
    ~EventFeed();

    // Returns what is known of the stations, sorted.
    [[nodiscard]] std::vector<StationNews::Page> stations() const;
    // Counts its looks at the catalog that have ended, with what they found told.
    [[nodiscard]] std::uint64_t looks() const;
    // Counts grids that could not be read.
    [[nodiscard]] std::uint64_t unreadable() const;

  private:
    struct Impl;
    explicit EventFeed(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::web
