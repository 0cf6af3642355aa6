// tests/service/fake_notifier.h -- records the messages to the service manager.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "service/notify.h"

namespace stormcellar {

class FakeNotifier final : public Notifier {
  public:
    void send(const std::string& state) override {
        const std::lock_guard lock(mutex_);
        sent_.push_back(state);
    }
    [[nodiscard]] std::optional<std::chrono::microseconds> watchdog() const override {
        return period;
    }
    [[nodiscard]] std::vector<std::string> sent() const {
        const std::lock_guard lock(mutex_);
        return sent_;
    }

    std::optional<std::chrono::microseconds> period;  // set before first use

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> sent_;
};

}  // namespace stormcellar
