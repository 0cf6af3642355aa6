// daemon/process/signals.h -- signals to poll for, instead of interruptions.
//
// Create the object before any thread starts: it blocks SIGTERM, SIGINT and SIGHUP for this thread
// and those that it starts, and ignores SIGPIPE. Thread contract: one thread.
#pragma once

#include <functional>
#include <optional>

#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

class Signals {
  public:
    static Result<Signals> open();
    Signals(Signals&& other) noexcept;
    Signals& operator=(Signals&&) = delete;
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;
    ~Signals();

    [[nodiscard]] int descriptor() const { return descriptor_; }
    // The number of a pending signal; none if there is none. Never blocks.
    [[nodiscard]] std::optional<int> next() const;

  private:
    explicit Signals(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

// Handles the pending signals: calls `reload` for each SIGHUP. Returns true if one of them asked
// the process to end, and logs that. `signals` may be null: then there are none.
[[nodiscard]] bool take_signals(const Signals* signals, const std::function<void()>& reload);

}  // namespace stormcellar::daemon
