// daemon/log/line_limiter.h -- how many log lines of a kind are allowed, so that a hostile or
// broken feed cannot fill the disk with them.
//
// A kind is an event of one subject (a station, a loop). In addition all subjects of an event share
// a limit. Lines beyond a limit are counted, and their number is reported when the minute is over.
// Memory is bounded whatever is logged: beyond `most_subjects` only the limit for all holds, so
// that names invented by files take no lines from other subjects. Thread contract: plain data; use
// it from one thread, or under a lock. The caller passes the time.
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

#include "base/steady_time.h"
#include "daemon/log/log_event.h"

namespace stormcellar::daemon {

enum class Severity { debug, info, warning, error };

// Lets `most` lines through in each period and counts the rest.
class RateLimit {
  public:
    RateLimit(int most, std::chrono::seconds period) : most_(most), period_(period) {}
    // Returns true if the line may be logged.
    bool allow(SteadyTime now);
    // How many lines were held back, once their period is over; counting then starts again at zero.
    std::optional<std::uint64_t> take_held_back(SteadyTime now);
    // Returns true if the object can be dropped: its period is over, and it holds nothing back.
    [[nodiscard]] bool is_idle(SteadyTime now) const {
        return held_back_ == 0 && now - began_ >= period_;
    }

  private:
    int most_;
    std::chrono::seconds period_;
    SteadyTime began_{};
    int used_ = 0;
    std::uint64_t held_back_ = 0;
};

class LineLimiter {
  public:
    static constexpr std::chrono::seconds period{60};
    static constexpr std::size_t most_subjects = 512;  // of all events
    struct Most {
        int of_one, of_all;  // lines a period: for one subject, for all subjects
    };
    // A healthy feed never loses a line: 160 sites send some 40 volumes a minute.
    [[nodiscard]] static Most most_of(Event event) {
        return event == Event::gridded ? Most{60, 600} : Most{20, 120};
    }

    // Returns true if the line may be logged.
    bool allow(Event event, std::string_view subject, Severity severity, SteadyTime now);

    struct HeldBack {
        Event event;
        std::string subject;  // empty: several subjects, or none
        Severity severity;    // the gravest of the lines
        std::uint64_t lines;
    };
    // What was held back in minutes that are over.
    std::vector<HeldBack> take_held_back(SteadyTime now);
    // How many kinds are remembered.
    [[nodiscard]] std::size_t subjects() const { return each_.size(); }

  private:
    struct Kind {
        RateLimit limit;
        Severity gravest = Severity::debug;  // of the lines that were held back
    };
    static void take(Kind& kind, Event event, const std::string& subject, SteadyTime now,
                     std::vector<HeldBack>& held);

    std::map<std::pair<Event, std::string>, Kind> each_;
    std::map<Event, Kind> all_;
};

}  // namespace stormcellar::daemon
