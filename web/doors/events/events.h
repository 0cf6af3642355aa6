// web/doors/events/events.h -- server-sent events: what happens in cache and catalog, as it happens
// (docs/web/events.md).
//
//   /api/v1/events?station=&domain=&moment=&kind=&last_event_id=
//
// A client hears of the places that it names, all if it names none, and of these the moments and
// kinds that it names. A slow one keeps no more than one block of the
// server's and what the kernel holds for its socket: what it did not read while it was in the ring
// of the newest events is lost to it, and it is told so (reset).
//
// Threads   As Door.
// Errors    400 for a parameter that makes no sense, 404 below the path, 503 beyond the number of
//           streams, in all or of one client.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "web/data/events/event_feed.h"
#include "web/data/events/event_hub.h"
#include "web/http/door.h"

namespace stormcellar::web {

struct EventsOptions {
    std::shared_ptr<EventHub> hub = {};
    std::shared_ptr<const EventFeed> feed =
        {};  // what publishes; the door keeps it alive; may be null
    std::size_t most_streams = 2048;
    std::size_t most_of_client = 64;
};

class EventsDoor final : public Door {
  public:
    explicit EventsDoor(EventsOptions options);
    ~EventsDoor() override;
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

    // Counts requests that were refused for the number of streams.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

  private:
    class Places;
    const EventsOptions options_;
    const std::shared_ptr<Places> places_;
    std::atomic<std::uint64_t> refused_{0};
};

}  // namespace stormcellar::web
