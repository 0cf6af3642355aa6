// daemon/log/log.h -- log lines: one for each event, with its subject, and where the lines go.
//
// If stderr is the journal (JOURNAL_STREAM names it), lines go to the journal with fields:
//   MESSAGE, PRIORITY, SYSLOG_IDENTIFIER, STORMCELLAR_EVENT (log_event.h), and if they are known
//   STORMCELLAR_STATION, _VOLUME (ISO 8601 UTC), _FILE (not escaped, any bytes), _LATENCY_S (close
//   to cache), _TOOK_S (the work alone), _LOOP, _DOMAIN, _REASON (the kind of an error, as in the
//   metrics), _HELD_BACK (how many lines this line stands for)
// Otherwise they go to stderr, with time and level for people. If stderr is the journal but its
// socket accepts nothing, they go to stderr with syslog's "<N>" level prefix. Lines above level
// debug are limited (line_limiter.h). A caller passes names from outside through printable(); the
// fields of About are escaped where necessary. Thread contract: call set_up_logging() before other
// threads start; any thread may call the others.
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
    std::filesystem::path journal;      // the journal's socket; empty: lines go to stderr
    std::function<SteadyTime()> clock;  // empty: the steady clock
};
// `level` is one of debug, info, warning, error.
void set_up_logging(const std::string& level, LogOutlet outlet = {});
void set_log_level(const std::string& level);

// Returns true if stderr is the stream that JOURNAL_STREAM=device:inode names.
[[nodiscard]] bool stderr_is_journal();
// The journal, with its usual socket, if stderr is a journal stream; otherwise stderr.
[[nodiscard]] LogOutlet usual_outlet();

// What a line is about; empty members are left out.
struct About {
    Event event;
    std::string station{};
    std::optional<UtcTime> volume{};
    std::filesystem::path file{};
    std::optional<double> latency_s{};  // from the close, if it was seen, to the cache
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

// Logs one line for each kind of which lines were held back in a minute that is over. Call it every
// few seconds. At the end of the process it also reports the minute that is not over.
void log_held_back();
void log_all_held_back();

}  // namespace stormcellar::daemon
