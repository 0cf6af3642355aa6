// daemon/log/line_limiter.h -- limits the number of log lines of each kind, so that a hostile or
// broken feed cannot fill the disk with lines.
//
// A kind of line is an event of one subject (a station or a loop). Each kind has a limit, and all
// subjects of an event share a second limit. Lines over a limit are counted, and the count is
// logged at the end of the minute. Memory is bounded: beyond `most_subjects`, only the shared limit
// applies to new subjects.
//
// Threads   Plain data: one thread at a time, or under a lock. The caller passes the current time.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/rate_limit.h"
#include "base/steady_time.h"
#include "daemon/log/log_event.h"
#include "service/log.h"

namespace stormcellar::daemon {

class LineLimiter {
  public:
    static constexpr std::chrono::seconds period{60};
    static constexpr std::size_t most_subjects = 512;  // of all events together
    struct Most {
        int of_one, of_all;  // lines per period of one subject, and of all subjects together
    };
    // A healthy feed never reaches the limits: 160 sites send about 40 volumes a minute.
    [[nodiscard]] static Most most_of(Event event) {
        return event == Event::gridded ? Most{60, 600} : Most{20, 120};
    }

    // Returns true if the line may be logged.
    bool allow(Event event, std::string_view subject, LogLevel level, SteadyTime now);

    struct HeldBack {
        Event event;
        std::string subject;  // empty: several subjects, or none
        LogLevel level;       // the most severe level
        std::uint64_t lines;
    };
    // Returns how many lines of each kind were held back in past minutes, and forgets these
    // numbers.
    std::vector<HeldBack> take_held_back(SteadyTime now);
    // Returns the number of remembered subjects.
    [[nodiscard]] std::size_t subjects() const { return each_.size(); }

  private:
    struct Kind {
        RateLimit limit;
        LogLevel gravest = LogLevel::debug;  // most severe of the lines held back
    };
    static void take(Kind& kind, Event event, const std::string& subject, SteadyTime now,
                     std::vector<HeldBack>& held);

    std::map<std::pair<Event, std::string>, Kind> each_;
    std::map<Event, Kind> all_;
};

}  // namespace stormcellar::daemon
