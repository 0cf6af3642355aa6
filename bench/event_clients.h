// bench/event_clients.h -- many clients that read the events of a data server at the same time.
//
// Threads   One thread at a time may use an EventClients, which reads in a thread of its own.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct HeardEvent {
    std::size_t client = 0;
    std::chrono::steady_clock::time_point at;  // when the last byte of the event was read
    std::string type, station, grid;           // grid: the time of the grid
};

class EventClients {
  public:
    EventClients();
    ~EventClients();  // ends the streams

    // Opens a stream of /api/v1/events for each query ("station=KTLX"), one after another. Errors:
    // io if a stream is refused.
    [[nodiscard]] static Result<std::unique_ptr<EventClients>> open(
        int port, const std::vector<std::string>& queries);
    // Returns the events read since the last call, in the order in which they were read.
    [[nodiscard]] std::vector<HeardEvent> take();
    [[nodiscard]] std::size_t closed() const;  // streams that ended

  private:
    class Reader;
    std::unique_ptr<Reader> reader_;
};

}  // namespace stormcellar::bench
