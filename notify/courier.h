// notify/courier.h -- delivers the messages of one rule, the oldest first, and tries again after a
// failure.
//
// After a failure that may pass, the next try follows after a second. The pause doubles with each
// further failure, up to a minute. After a final failure (sender.h), or at an age of more than
// `longest_age`, a message is dropped with a line in the log. An old message helps nobody: the
// storm has moved on.
//
// Threads   One thread at a time.
// Errors    None are returned. Of several failures in a row that may pass, only the first is
//           logged.
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "base/steady_time.h"
#include "notify/outbox.h"
#include "notify/sender.h"
#include "service/log.h"

namespace stormcellar::notify {

inline constexpr std::chrono::minutes longest_age{60};  // since the time of the grid

class Courier {
  public:
    // `outbox` must outlive the courier.
    Courier(std::string rule, Outbox& outbox, Sender send)
        : rule_(std::move(rule)), outbox_(outbox), send_(std::move(send)) {}

    // Drops messages that are too old. If a message waits and a try is due, tries to deliver it.
    // Returns true if the message was delivered or dropped, so that the next message may follow at
    // once.
    bool step(UtcTime now, SteadyTime steady);

  private:
    void drop_old(UtcTime now);
    void settle(const MessageName& name);
    void note_outcome(const MessageName& name, const Status& done, SteadyTime steady);

    const std::string rule_;
    Outbox& outbox_;
    const Sender send_;
    FirstFailure settled_;
    int failures_ = 0;  // in a row
    SteadyTime next_try_{};
};

}  // namespace stormcellar::notify
