// daemon/process/signals.h -- signals as something to poll for, not as interruptions.
//
// Make one before any thread starts: it blocks SIGTERM, SIGINT and SIGHUP for this thread and those
// that it starts, and ignores SIGPIPE.
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
    // The number of a signal that waits; none when there is none. Never blocks.
    [[nodiscard]] std::optional<int> next() const;

  private:
    explicit Signals(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

// Takes those that wait: `reload` is called for each SIGHUP. True when one of them asked for the
// end, which is logged. No signals (null): there are none.
[[nodiscard]] bool take_signals(const Signals* signals, const std::function<void()>& reload);

}  // namespace stormcellar::daemon
