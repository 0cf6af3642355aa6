// web/data/events/grid_events.h -- turns changes in the cache into events.
//
// The header of a grid tells what it is: the living grid of a growing volume, the grid of an ended
// volume, or a mosaic. Partials, which are grids of single sites for a mosaic, give no events.
//
// The times of directories are coarse, so the watch may report an unchanged grid as changed.
// Therefore, grids that were written before the server began, and files that were already reported,
// give no events. If such files appear, as when a disk is mounted, a reset follows.
//
// Threads   One thread at a time.
// Errors    None are returned. A grid that cannot be read is counted. At its next change it is
//           reported, if it can then be read.
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
    // Grids that were written before `began_ns` give no events. `began_ns` is a time since the
    // epoch by the clock that dates files.
    GridEvents(std::shared_ptr<Grids> grids, StationNews& book, std::int64_t began_ns)
        : grids_(std::move(grids)), book_(book), began_ns_(began_ns) {}

    // Returns the events of these changes, in their order. If a grid changed several times, only
    // the last change counts. All grids of a domain and moment that are gone give one event.
    [[nodiscard]] std::vector<Event> of(std::span<const CacheChange> changes, UtcTime now);

    // Returns the number of grids that could not be read.
    [[nodiscard]] std::uint64_t unreadable() const { return unreadable_; }

  private:
    // Identifies a file. A later file with the same name differs in at least one member.
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
    // True if old files appeared, as when a disk is mounted. There may be too many to report each,
    // so a reset follows.
    bool came_back_ = false;
    std::map<Place, std::vector<Told>> told_;  // the files that were last reported
};

// Returns the time since the epoch by the clock with which the kernel dates files.
[[nodiscard]] std::int64_t file_clock_ns();

}  // namespace stormcellar::web
