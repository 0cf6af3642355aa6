// daemon/process/signals.h -- signals as events to poll for instead of interruptions.
//
// Make one object before any thread starts: it blocks SIGTERM, SIGINT and SIGHUP for this thread
// and the threads that it starts, and ignores SIGPIPE.
//
// Threads   One thread at a time.
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
    // Returns the number of a pending signal, or none. Never blocks.
    [[nodiscard]] std::optional<int> next() const;

  private:
    explicit Signals(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

// Takes all pending signals and calls `reload` for each SIGHUP. Returns true if one of them asked
// for the end, which is logged. A null `signals` has none.
[[nodiscard]] bool take_signals(const Signals* signals, const std::function<void()>& reload);

}  // namespace stormcellar::daemon
