// daemon/process/wake_up.h -- an event that any thread can raise and one thread polls for
// (eventfd).
#pragma once

namespace stormcellar::daemon {

class WakeUp {
  public:
    WakeUp();  // throws std::system_error when the process has no descriptors left
    WakeUp(const WakeUp&) = delete;
    WakeUp& operator=(const WakeUp&) = delete;
    ~WakeUp();

    void set();
    void clear();
    [[nodiscard]] int descriptor() const { return descriptor_; }

  private:
    int descriptor_;
};

}  // namespace stormcellar::daemon
