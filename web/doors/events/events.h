// web/doors/events/events.h -- server-sent events from cache and catalog, as changes happen
// (docs/web/events.md).
//
//   /api/v1/events?station=&domain=&moment=&kind=&last_event_id=
//
// A client hears of the stations and domains that it names, or of all stations and domains if it
// names none. If it names moments and kinds, it hears only of these. A slow client takes at most
// one block of the server's memory, and the kernel's buffer of its socket. If an event leaves the
// ring of the newest events before the client has read it, the event is lost, and the client gets a
// reset.
//
// Threads   Many threads may use it.
// Errors    400 for a parameter that makes no sense, 404 for other paths below /api/v1/events, 503
//           if too many streams are open, in all or for one client.
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
        {};  // publishes the events; the door keeps it alive; may be null
    std::size_t most_streams = 2048;
    std::size_t most_of_client = 64;
};

class EventsDoor final : public Door {
  public:
    explicit EventsDoor(EventsOptions options);
    ~EventsDoor() override;
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

    // Returns how many requests were refused because too many streams were open.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

  private:
    class Places;
    const EventsOptions options_;
    const std::shared_ptr<Places> places_;
    std::atomic<std::uint64_t> refused_{0};
};

}  // namespace stormcellar::web
