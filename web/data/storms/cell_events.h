// web/data/storms/cell_events.h -- publishes an event when the cells of a new grid of reflectivity
// have been found.
//
// One thread searches the grids, so other events need not wait. If several grids of an area come
// while the area waits for its search, only the newest is searched. Each grid gives one event, and
// one more if the grid is made again.
//
// Threads   Many threads may use it.
// Errors    None are returned. A grid that cannot be read, and areas beyond `most_waiting`, give no
//           event.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "stormcellar/base/mutex.h"
#include "web/data/events/event_hub.h"
#include "web/data/storms/storm_scans.h"
#include "web/http/work_queue.h"

namespace stormcellar::web {

class CellEvents {
  public:
    static constexpr std::size_t most_waiting = 256;

    CellEvents(std::shared_ptr<StormScans> scans, std::shared_ptr<EventHub> hub)
        : scans_(std::move(scans)), hub_(std::move(hub)) {}

    // Notes that an area has a new grid of reflectivity. Returns at once.
    void hear(const std::string& area);

  private:
    void search(const std::string& area);

    const std::shared_ptr<StormScans> scans_;
    const std::shared_ptr<EventHub> hub_;
    Mutex mutex_;
    std::set<std::string> waiting_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::string, StormScans::Scan> told_ STORMCELLAR_GUARDED_BY(mutex_);
    WorkQueue workers_{1, most_waiting};  // last, so that its thread ends first
};

}  // namespace stormcellar::web
