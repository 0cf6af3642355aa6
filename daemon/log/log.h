// daemon/log/log.h -- log lines: one an event, with what it is about, and where they go.
//
// To the journal with fields, when stderr is the journal (JOURNAL_STREAM names it):
//   MESSAGE, PRIORITY, SYSLOG_IDENTIFIER, STORMCELLAR_EVENT (log_event.h), and where they are known
//   STORMCELLAR_STATION, _VOLUME (ISO 8601 UTC), _FILE (as it is, any bytes), _LATENCY_S (close to
//   cache), _TOOK_S (the work alone), _LOOP, _DOMAIN, _REASON (the kind of an error, as in the
//   metrics), _HELD_BACK (lines that this one stands for)
// Else to stderr: with time and level for people; with syslog's "<N>" level prefix when stderr is
// the journal and its socket takes nothing.
// Lines above debug are limited (line_limiter.h). Whoever logs a name from outside passes it
// through printable(); what is in About is escaped where it must be.
// Thread contract: set_up_logging() before other threads start; the others from any thread.
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
#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {

struct LogOutlet {
    std::filesystem::path journal;      // its socket; empty: lines go to stderr
    std::function<SteadyTime()> clock;  // empty: the steady clock
};
// `level` is one of debug, info, warning, error.
void set_up_logging(const std::string& level, LogOutlet outlet = {});
void set_log_level(const std::string& level);

// True when stderr is the stream that JOURNAL_STREAM=device:inode names.
[[nodiscard]] bool stderr_is_journal();
// The journal, with its usual socket, when stderr is one; else stderr.
[[nodiscard]] LogOutlet usual_outlet();

// What a line is about; what is empty is left out.
struct About {
    Event event;
    std::string station{};
    std::optional<UtcTime> volume{};
    std::filesystem::path file{};
    std::optional<double> latency_s{};  // from the close that was seen to the cache
    std::optional<double> took_s{};     // the work alone
    std::string loop{};
    std::string domain{};
    std::string_view reason{};
};

void log_line(Severity severity, const About& about, std::string_view message);

template <class... Arguments>
void log_debug(const About& about, fmt::format_string<Arguments...> text, Arguments&&... values) {
    log_line(Severity::debug, about, fmt::format(text, std::forward<Arguments>(values)...));
}
template <class... Arguments>
void log_info(const About& about, fmt::format_string<Arguments...> text, Arguments&&... values) {
    log_line(Severity::info, about, fmt::format(text, std::forward<Arguments>(values)...));
}
template <class... Arguments>
void log_warning(const About& about, fmt::format_string<Arguments...> text, Arguments&&... values) {
    log_line(Severity::warning, about, fmt::format(text, std::forward<Arguments>(values)...));
}
template <class... Arguments>
void log_error(const About& about, fmt::format_string<Arguments...> text, Arguments&&... values) {
    log_line(Severity::error, about, fmt::format(text, std::forward<Arguments>(values)...));
}

// One line for each kind of which lines were held back in a minute that is over; call it every few
// seconds. At the end, in one that is not over either.
void log_held_back();
void log_all_held_back();

}  // namespace stormcellar::daemon
