#include "service/log.h"

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>

#include <sys/stat.h>
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

const LevelFacts& facts_of(LogLevel level) {
    return facts_of_levels[static_cast<std::size_t>(level)];
}

}  // namespace

void set_log_level(std::string_view name) {
    for (std::size_t i = 0; i < facts_of_levels.size(); ++i)
        if (facts_of_levels[i].name == name) least_level = static_cast<LogLevel>(i);
}

bool is_logged(LogLevel level) {
    return level >= least_level.load();
}

char priority_of(LogLevel level) {
    return facts_of(level).priority;
}

bool stderr_is_journal() {
    const char* stream = std::getenv("JOURNAL_STREAM");
    struct stat facts {};
    if (stream == nullptr || ::fstat(STDERR_FILENO, &facts) != 0) return false;
    return fmt::format("{}:{}", facts.st_dev, facts.st_ino) == stream;
}

void write_log(LogLevel level, std::string_view text) {
    const std::string line = stderr_is_journal()
                                 ? fmt::format("<{}>{}\n", priority_of(level), printable(text))
                                 : fmt::format("{} {}: {}\n", format_utc(now_utc()),
                                               facts_of(level).name, printable(text));
    // Use one write, so that lines of several threads do not mix. A failure cannot be reported.
    (void)!::write(STDERR_FILENO, line.data(), line.size());
}

}  // namespace stormcellar
