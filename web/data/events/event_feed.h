// web/data/events/event_feed.h -- watches the cache and the catalog, and publishes what happens
// there.
//
// The daemon sends no messages to the data server. The feed sees each grid when the daemon renames
// it into the cache (web/data/grids/cache_watch.h). Every two seconds it checks which stations'
// databases were written. The grids of a station show when its volumes begin and end. If a station
// has had no grid for 30 seconds, the feed takes the beginnings and ends of its volumes from the
// catalog.
//
// Threads   Many threads may use it. The feed has one thread of its own, which reads and publishes.
// Errors    If the catalog does not exist (yet), it has no stations. unreadable() counts grids that
//           cannot be read.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/catalog/catalog.h"
#include "web/data/events/event_hub.h"
#include "web/data/events/station_news.h"
#include "web/data/grids/grids.h"

namespace stormcellar::web {

struct EventFeedOptions {
    std::shared_ptr<Grids> grids;   // null: no cache
    std::filesystem::path catalog;  // empty: none
    // A reader of this catalog, if it is already open.
    std::shared_ptr<const catalog::CatalogReader> reader = nullptr;
    std::shared_ptr<EventHub> hub;
    // Called with the domain after the events of a finished grid of reflectivity were published.
    // The function must be quick.
    std::function<void(const std::string&)> on_reflectivity = nullptr;
    std::chrono::seconds silent_after{1200};
    std::chrono::milliseconds look_every{2000};  // time between two looks at the catalog
};

class EventFeed {
  public:
    // Starts the feed. It publishes nothing about grids and volumes that exist already. It reads
    // one row of each station.
    static std::unique_ptr<EventFeed> open(EventFeedOptions options);
    EventFeed(const EventFeed&) = delete;
    EventFeed& operator=(const EventFeed&) = delete;
    ~EventFeed();

    // Returns the known facts about the stations, sorted.
    [[nodiscard]] std::vector<StationNews::Page> stations() const;
    // Returns how often the feed has looked at the catalog. The events of these looks have been
    // published.
    [[nodiscard]] std::uint64_t looks() const;
    // Returns the number of grids that could not be read.
    [[nodiscard]] std::uint64_t unreadable() const;

  private:
    struct Impl;
    explicit EventFeed(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::web
