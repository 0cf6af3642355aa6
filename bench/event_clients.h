// bench/event_clients.h -- many clients of /api/v1/events, read by one thread of its own.
//
// Threads   One thread at a time uses it.
// Errors    io if a connection fails or a stream is refused, with what the server said.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct HeardEvent {
    std::size_t client = 0;
    std::chrono::steady_clock::time_point at;  // when its last byte was read
    std::string type, station, grid;           // grid: its time, as the event says it
};

class EventClients {
  public:
    // Opens a stream for each query ("station=KTLX"), one after another.
    [[nodiscard]] static Result<std::unique_ptr<EventClients>> open(
        int port, const std::vector<std::string>& queries);
    EventClients(const EventClients&) = delete;
    EventClients& operator=(const EventClients&) = delete;
    ~EventClients();

    // Returns what was heard since the last call, in the order in which it was read.
    [[nodiscard]] std::vector<HeardEvent> take();
    // Waits for the first event of one of these types; drops all before it.
    [[nodiscard]] std::optional<HeardEvent> wait_for(const std::vector<std::string>& types,
                                                     std::chrono::milliseconds most);
    [[nodiscard]] std::size_t closed() const;  // streams that ended

  private:
    struct Impl;
    explicit EventClients(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::bench
