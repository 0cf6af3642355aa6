// daemon/log/log.h -- writes one log line for each event, with the objects that the event concerns.
//
// If stderr is the journal (JOURNAL_STREAM names it), lines go to the journal with these fields:
//   MESSAGE, PRIORITY, SYSLOG_IDENTIFIER, STORMCELLAR_EVENT (log_event.h)
// and, if they are known:
//   STORMCELLAR_STATION
//   STORMCELLAR_VOLUME     ISO 8601 UTC
//   STORMCELLAR_FILE       unchanged, any bytes
//   STORMCELLAR_LATENCY_S  from the close of the file until its grids are in the cache
//   STORMCELLAR_TOOK_S     the time of the work, without waiting
//   STORMCELLAR_LOOP, STORMCELLAR_DOMAIN
//   STORMCELLAR_REASON     the kind of an error, as in the metrics
//   STORMCELLAR_HELD_BACK  number of lines that this line sums up
// Otherwise lines go to stderr with time and level. If stderr is the journal but its socket accepts
// nothing, lines go to stderr with the "<N>" level prefix of syslog.
//
// The number of lines above the level debug is limited (line_limiter.h). The caller passes names
// from outside through printable() before it puts them into a message. Members of About are escaped
// here where necessary.
//
// Threads   Call set_up_logging() before other threads start. Any thread may call the other
//           functions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/steady_time.h"
#include "daemon/log/line_limiter.h"
#include "daemon/log/log_event.h"
#include "service/log.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {

struct LogOutlet {
    std::filesystem::path journal;      // the journal's socket; empty: lines go to stderr
    std::function<SteadyTime()> clock;  // empty: the steady clock
};
// Sets where lines go, and the level: debug, info, warning or error. set_log_level() of
// service/log.h changes the level later.
void set_up_logging(std::string_view level, LogOutlet outlet = {});

// Returns the journal with its usual socket if stderr is the journal, else stderr.
[[nodiscard]] LogOutlet usual_outlet();

// The fields of a line. Empty members are left out.
struct About {
    Event event;
    std::string station{};
    std::optional<UtcTime> volume{};
    std::filesystem::path file{};
    // From the close of the file until its grids are in the cache.
    std::optional<double> latency_s{};
    std::optional<double> took_s{};  // the work alone
    std::string loop{};
    std::string domain{};
    std::string_view reason{};
};

void log_line(LogLevel level, const About& about, std::string_view message);

template <LogLevel level>
struct LogAt {
    template <class... Arguments>
    void operator()(const About& about, fmt::format_string<Arguments...> text,
                    Arguments&&... values) const {
        log_line(level, about, fmt::format(text, std::forward<Arguments>(values)...));
    }
};
inline constexpr LogAt<LogLevel::debug> log_debug;
inline constexpr LogAt<LogLevel::info> log_info;
inline constexpr LogAt<LogLevel::warning> log_warning;
inline constexpr LogAt<LogLevel::error> log_error;

// log_held_back() logs one line for each kind of line that was held back in past minutes; call it
// every few seconds. log_all_held_back() includes the current minute; call it when the program
// ends.
void log_held_back();
void log_all_held_back();

}  // namespace stormcellar::daemon
