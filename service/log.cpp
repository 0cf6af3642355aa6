#include "service/log.h"

#include <array>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <string>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/printable.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar {
namespace {

struct LevelFacts {
    std::string_view name;
    char priority;  // of syslog(3)
    spdlog::level::level_enum level;
};
constexpr std::array<LevelFacts, 4> facts_of_levels = {{{"debug", '7', spdlog::level::debug},
                                                        {"info", '6', spdlog::level::info},
                                                        {"warning", '4', spdlog::level::warn},
                                                        {"error", '3', spdlog::level::err}}};

const LevelFacts& facts_of(LogLevel level) {
    return facts_of_levels[static_cast<std::size_t>(level)];
}

// Formats a line for the journal or for people, depending on where stderr goes when the line is
// written.
class LineFormatter final : public spdlog::formatter {
  public:
    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
        const std::string_view text(message.payload.data(), message.payload.size());
        for (const LevelFacts& facts : facts_of_levels) {
            if (facts.level != message.level) continue;
            if (stderr_is_journal())
                fmt::format_to(std::back_inserter(line), "<{}>{}\n", facts.priority, text);
            else
                fmt::format_to(std::back_inserter(line), "{} {}: {}\n", format_utc(now_utc()),
                               facts.name, text);
        }
    }
    [[nodiscard]] std::unique_ptr<spdlog::formatter> clone() const override {
        return std::make_unique<LineFormatter>();
    }
};

// Returns the logger. It writes each line with one call, so that lines of several threads do not
// mix.
spdlog::logger& logger() {
    static spdlog::logger the_logger = [] {
        spdlog::logger made("stormcellar", std::make_shared<spdlog::sinks::stderr_sink_mt>());
        made.set_formatter(std::make_unique<LineFormatter>());
        return made;
    }();
    return the_logger;
}

}  // namespace

void set_log_level(std::string_view name) {
    for (const LevelFacts& facts : facts_of_levels)
        if (facts.name == name) logger().set_level(facts.level);
}

bool is_logged(LogLevel level) {
    return logger().should_log(facts_of(level).level);
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
    logger().log(facts_of(level).level, "{}", printable(text));
}

}  // namespace stormcellar
