// service/signals.h -- turns signals into events that a thread waits for, or blocks them.
//
// Make one object of Signals before any thread starts: it blocks SIGTERM, SIGINT and SIGHUP for
// this thread and the threads that it starts, and ignores SIGPIPE. A signal that arrives waits for
// next().
//
// Threads   Signals: one thread at a time.
#pragma once

#include <chrono>
#include <csignal>
#include <initializer_list>
#include <optional>
#include <span>
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

// Blocks signals in this thread, and in those that it starts, while the object exists.
class BlockedSignals {
  public:
    explicit BlockedSignals(std::span<const int> numbers);
    explicit BlockedSignals(std::initializer_list<int> numbers)
        : BlockedSignals(std::span(numbers.begin(), numbers.size())) {}
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;
    ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  private:
    sigset_t before_{};
};

// Returns "SIGTERM" or "SIGINT", for the log.
[[nodiscard]] std::string_view name_of_ending(int signal);

}  // namespace stormcellar
