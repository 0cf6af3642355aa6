#include "service/log.h"

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>
#include <utility>

#include <unistd.h>

#include "base/printable.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar {
namespace {

struct LevelFacts {
    std::string_view name;
    char priority;  // of syslog(3)
};
constexpr std::array<LevelFacts, 4> facts_of_levels = {
    {{"debug", '7'}, {"info", '6'}, {"warning", '4'}, {"error", '3'}}};

std::atomic<LogLevel> least_level{LogLevel::info};

// Returns true if the journal takes stderr. systemd sets this variable if it takes stdout or
// stderr.
bool journal_takes_stderr() {
    static const bool takes = std::getenv("JOURNAL_STREAM") != nullptr && ::isatty(2) == 0;
    return takes;
}

}  // namespace

void set_log_level(std::string_view name) {
    for (std::size_t i = 0; i < facts_of_levels.size(); ++i)
        if (facts_of_levels[i].name == name) least_level = static_cast<LogLevel>(i);
}

bool is_logged(LogLevel level) {
    return level >= least_level.load();
}

void write_log(LogLevel level, std::string_view text) {
    const LevelFacts& facts = facts_of_levels[static_cast<std::size_t>(level)];
    const std::string line =
        journal_takes_stderr()
            ? fmt::format("<{}>{}\n", facts.priority, printable(text))
            : fmt::format("{} {}: {}\n", format_utc(now_utc()), facts.name, printable(text));
    // Use one write, so that lines of several threads do not mix. A failure cannot be reported.
    (void)!::write(STDERR_FILENO, line.data(), line.size());
}

}  // namespace stormcellar
