// service/signals.h -- turns signals into events that a thread waits for, or blocks signals.
//
// Call Signals::open() once, before any thread starts. It blocks SIGTERM, SIGINT and SIGHUP for
// this thread and for the threads that this thread starts, and ignores SIGPIPE. A blocked signal
// waits until next() returns it.
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
    // Blocks the signals. Errors: io if no descriptor is left; internal if signals cannot be
    // blocked.
    static Result<Signals> open();

    // Returns a descriptor for poll(), which is readable while a signal waits.
    [[nodiscard]] int descriptor() const { return descriptor_.number(); }
    // Returns the number of a signal; none if no signal comes within `most`.
    [[nodiscard]] std::optional<int> next(
        std::chrono::milliseconds most = std::chrono::milliseconds{0}) const;

  private:
    explicit Signals(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}
    Descriptor descriptor_;
};

// Blocks signals while the object exists, in this thread and in threads that this thread starts.
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

// Returns the name of a signal that ends a service: "SIGTERM" or "SIGINT".
[[nodiscard]] std::string_view name_of_ending(int signal);

}  // namespace stormcellar
