// daemon/process/wake_up.h -- an event that any thread can raise, and for which one thread polls
// (eventfd).
#pragma once

#include "stormcellar/base/descriptor.h"

namespace stormcellar::daemon {

class WakeUp {
  public:
    WakeUp();  // throws std::system_error when the process has no descriptors left

    void set();
    void clear();
    [[nodiscard]] int descriptor() const { return descriptor_.number(); }

  private:
    Descriptor descriptor_;
};

}  // namespace stormcellar::daemon
