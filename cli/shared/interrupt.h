// cli/shared/interrupt.h -- Ctrl-C as a flag that long work looks at between its steps.
//
// As long as an Interrupt lives, the first SIGINT, SIGTERM or SIGHUP sets the flag instead of
// ending the program (a signal that was ignored stays ignored); a second one ends it at once. The
// work looks at the flag, lets go of what it has half done, and calls end_by_signal(). One
// Interrupt at a time.
#pragma once

#include <array>
#include <atomic>

#include <signal.h>

namespace stormcellar::cli {

class Interrupt {
  public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    ~Interrupt();

    [[nodiscard]] const std::atomic<bool>& flag() const;
    // Ends the program by the signal that came, so that a shell sees why it ended. Returns when
    // none came.
    void end_by_signal();

  private:
    static constexpr std::array watched{SIGINT, SIGTERM, SIGHUP};
    void restore();

    std::array<struct sigaction, watched.size()> before_{};
};

}  // namespace stormcellar::cli
