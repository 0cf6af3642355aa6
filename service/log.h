// service/log.h -- writes log lines of a service to stderr. Only programs and their services call
// these functions directly; the daemon calls them through daemon/log/log.h.
//
// If stderr is the journal, each line begins with the prefix "<N>", from which the journal takes
// the level. Otherwise each line begins with the time and the level. Control characters are
// escaped.
//
// Threads   Any thread may call every function.
#pragma once

#include <string_view>

#include <fmt/format.h>

#include "stormcellar/base/result.h"

namespace stormcellar {

enum class LogLevel { debug, info, warning, error };

// Sets the lowest level that is written: `name` is debug, info, warning or error.
void set_log_level(std::string_view name);
[[nodiscard]] bool is_logged(LogLevel level);
// Returns the priority that syslog(3) gives to the level, as a digit.
[[nodiscard]] char priority_of(LogLevel level);
// Returns true if $JOURNAL_STREAM names stderr as the stream of the journal (DEVICE:INODE).
[[nodiscard]] bool stderr_is_journal();
// Writes a line whatever its level is.
void write_log(LogLevel level, std::string_view text);

template <class... Arguments>
void say(LogLevel level, fmt::format_string<Arguments...> text, Arguments&&... values) {
    if (is_logged(level)) write_log(level, fmt::format(text, std::forward<Arguments>(values)...));
}

// Logs a failure, unless the previous status was a failure, too.
class FirstFailure {
  public:
    void note(const Status& status) {
        if (!status && was_fine_) say(LogLevel::error, "{}", status.error().message);
        was_fine_ = status.has_value();
    }

  private:
    bool was_fine_ = true;
};

}  // namespace stormcellar
