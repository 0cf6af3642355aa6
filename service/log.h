// service/log.h -- the lines that a service writes to stderr: start, stop, trouble.
// Only programs and their services call it; the daemon does through daemon/log/log.h.
//
// If stderr is the journal, lines carry the "<N>" prefix by which the journal knows their level;
// otherwise the time and the level. Control characters are escaped.
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
// Returns the priority of syslog(3), a digit.
[[nodiscard]] char priority_of(LogLevel level);
// Returns true if stderr is the stream that JOURNAL_STREAM=device:inode names.
[[nodiscard]] bool stderr_is_journal();
// Writes a line of any level.
void write_log(LogLevel level, std::string_view text);

template <class... Arguments>
void say(LogLevel level, fmt::format_string<Arguments...> text, Arguments&&... values) {
    if (is_logged(level)) write_log(level, fmt::format(text, std::forward<Arguments>(values)...));
}

// Logs the first of several failures in a row, and the next one only after a success.
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
