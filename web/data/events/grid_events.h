// web/data/events/grid_events.h -- what changes in the cache mean, as events.
//
// A grid says itself what it is: the living grid of a volume that grows, the grid of a volume that
// has ended, or a frame of a mosaic. What single sites gave to a mosaic (parts) is nobody's
// business.
//
// The watch may tell that a grid changed that lay there all the time, after a look at directories
// whose times are too coarse. So a grid that was written before the server began is no news, nor
// is a file that was told already.
//
// Threads   One thread at a time.
// Errors    None are returned: a grid that cannot be read is counted, and told of when it can be.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "cache/grid_facts.h"
#include "stormcellar/cache/grid_name.h"
#include "web/data/events/event.h"
#include "web/data/events/station_news.h"
#include "web/data/grids/cache_watch.h"
#include "web/data/grids/grids.h"

namespace stormcellar::web {

class GridEvents {
  public:
    // `began_ns`: what was written before that is no news; by the clock of files, since the epoch.
    GridEvents(std::shared_ptr<Grids> grids, StationNews& book, std::int64_t began_ns)
        : grids_(std::move(grids)), book_(book), began_ns_(began_ns) {}

    // Returns the events of these changes, in their order. Of a grid that changed several times,
    // the last counts. Grids that went become one event for each domain and moment.
    [[nodiscard]] std::vector<Event> of(std::span<const CacheChange> changes, UtcTime now);

    // Counts grids that could not be read.
    [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }

  private:
    // Tells a file from the next one of the same name.
    struct Told {
        UtcTime time;
        std::uint64_t inode = 0;
        std::int64_t modified_ns = 0;
        bool operator==(const Told&) const = default;
    };
    using Place = std::pair<std::string, level2::Moment>;

    void add_grid(const CacheChange& change, UtcTime now, std::vector<Event>& events);
    void add_evicted(const Place& place, std::vector<UtcTime> times, UtcTime now,
                     std::vector<Event>& events) const;
    [[nodiscard]] bool is_news(const cache::GridName& name, const Told& file);

    const std::shared_ptr<Grids> grids_;
    StationNews& book_;
    const std::int64_t began_ns_;
    std::uint64_t unreadable_ = 0;
    // Old files came under their names, as when a disk is mounted: too much to tell one by one.
    bool came_back_ = false;
    std::map<Place, std::vector<Told>> told_;  // the last few of each domain and moment
};

// Returns the time of the clock by which the kernel dates files, since the epoch.
[[nodiscard]] std::int64_t file_clock_ns();

}  // namespace stormcellar::web
