// web/service/measures.h -- the counters and gauges of one server, for /metrics.
//
// Threads   All measures are added before the server starts; after that, many threads may use them.
#pragma once

#include <atomic>
#include <memory>

#include "web/data/events/event_feed.h"
#include "web/data/events/event_hub.h"
#include "web/data/grids/grids.h"
#include "web/http/counters.h"
#include "web/http/door.h"
#include "web/http/server.h"

namespace stormcellar::web {

class Measures {
  public:
    // Adds the measures of the process and the server.
    Measures();

    [[nodiscard]] const std::shared_ptr<Counters>& counters() const { return counters_; }
    void count_doors(const Doors& doors);
    void watch_grids(const std::shared_ptr<Grids>& grids);
    void watch_events(const std::shared_ptr<EventHub>& hub,
                      const std::shared_ptr<const EventFeed>& feed);
    // Sets the server to measure. Call it when the server is open: the server is made later than
    // these measures, because its doors hold them. Nobody may read the measures after the server
    // has ended.
    void set_server(const Server* server) { *server_ = server; }

  private:
    const std::shared_ptr<Counters> counters_ = std::make_shared<Counters>();
    const std::shared_ptr<std::atomic<const Server*>> server_ =
        std::make_shared<std::atomic<const Server*>>(nullptr);
};

}  // namespace stormcellar::web
