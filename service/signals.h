// service/signals.h -- turns signals into events that a thread waits for.
//
// Make one object before any thread starts: it blocks SIGTERM, SIGINT and SIGHUP for this thread
// and the threads that it starts, and ignores SIGPIPE. A signal that arrives waits for next().
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar {

class Signals {
  public:
    // Errors: io if there is no descriptor.
    static Result<Signals> open();

    // Readable while a signal waits; for poll().
    [[nodiscard]] int descriptor() const { return descriptor_.number(); }
    // Returns the number of a signal, or none if none comes within this time.
    [[nodiscard]] std::optional<int> next(
        std::chrono::milliseconds most = std::chrono::milliseconds{0}) const;

  private:
    explicit Signals(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}
    Descriptor descriptor_;
};

// Returns "SIGTERM" or "SIGINT", for the log.
[[nodiscard]] std::string_view name_of_ending(int signal);

}  // namespace stormcellar
