// cli/shared/interrupt.h -- turns Ctrl-C into a flag that long work checks between its steps.
//
// While an Interrupt exists, the first SIGINT, SIGTERM or SIGHUP sets the flag instead of ending
// the program (an ignored signal stays ignored). A second signal ends the program at once. The work
// checks the flag, discards what it has half done, and calls end_by_signal().
//
// Threads   One Interrupt at a time; the flag may be read from any thread.
#pragma once

#include <atomic>

namespace stormcellar::cli {

class Interrupt {
  public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    ~Interrupt();

    [[nodiscard]] const std::atomic<bool>& flag() const;
    // Ends the program by the signal that arrived, so that a shell sees why the program ended.
    // Returns if no signal arrived.
    void end_by_signal();

  private:
    void restore();
};

}  // namespace stormcellar::cli
