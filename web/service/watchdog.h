// web/service/watchdog.h -- tells systemd that the data server is at work.
//
// The thread that feeds it must be able to ask the server for its facts, so a server that is stuck
// is started again. So is one that listens nowhere.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "base/steady_time.h"
#include "web/service/web_service.h"

namespace stormcellar::web {

class Watchdog {
  public:
    // Without a period it is never fed.
    Watchdog(std::optional<std::chrono::microseconds> period, std::function<void()> beat)
        : period_(period), beat_(std::move(beat)) {}
    // To be called often; it is fed four times in its period.
    void feed(const WebService& service, SteadyTime now) {
        if (!period_ || now < next_ || !service.is_listening()) return;
        next_ = now + *period_ / 4;
        (void)service.facts();
        beat_();
    }

  private:
    const std::optional<std::chrono::microseconds> period_;
    const std::function<void()> beat_;
    SteadyTime next_{};
};

}  // namespace stormcellar::web
