#include "daemon/log.h"

#include <cstdlib>
#include <memory>

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

namespace stormcellar::daemon {
namespace {

// syslog(3): 7 debug, 6 info, 4 warning, 3 error.
class SyslogLevel final : public spdlog::custom_flag_formatter {
  public:
    void format(const spdlog::details::log_msg& message, const std::tm&,
                spdlog::memory_buf_t& line) override {
        switch (message.level) {
            case spdlog::level::trace:
            case spdlog::level::debug:
                return line.append(std::string_view{"<7>"});
            case spdlog::level::info:
                return line.append(std::string_view{"<6>"});
            case spdlog::level::warn:
                return line.append(std::string_view{"<4>"});
            default:
                return line.append(std::string_view{"<3>"});
        }
    }
    [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
        return std::make_unique<SyslogLevel>();
    }
};

}  // namespace

bool stderr_is_journal() {
    const char* stream = std::getenv("JOURNAL_STREAM");
    struct stat facts {};
    if (stream == nullptr || ::fstat(STDERR_FILENO, &facts) != 0) return false;
    return fmt::format("{}:{}", facts.st_dev, facts.st_ino) == stream;
}

void set_up_logging(const std::string& level) {
    auto logger = std::make_shared<spdlog::logger>(
        "stormcellard", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    auto formatter = std::make_unique<spdlog::pattern_formatter>(
        stderr_is_journal() ? spdlog::pattern_time_type::local : spdlog::pattern_time_type::utc);
    formatter->add_flag<SyslogLevel>('*');
    formatter->set_pattern(stderr_is_journal() ? "%*%v" : "%Y-%m-%dT%H:%M:%S.%eZ %l: %v");
    logger->set_formatter(std::move(formatter));
    logger->flush_on(spdlog::level::debug);
    spdlog::set_default_logger(std::move(logger));
    set_log_level(level);
}

void set_log_level(const std::string& level) {
    spdlog::set_level(spdlog::level::from_str(level));
}

bool RateLimit::allow(SteadyTime now) {
    if (now - began_ >= period_ && held_back_ == 0) {
        began_ = now;
        used_ = 0;
    }
    if (used_ < most_) {
        ++used_;
        return true;
    }
    ++held_back_;
    return false;
}

std::optional<std::uint64_t> RateLimit::take_held_back(SteadyTime now) {
    if (held_back_ == 0 || now - began_ < period_) return std::nullopt;
    const std::uint64_t count = held_back_;
    held_back_ = 0;
    return count;
}

}  // namespace stormcellar::daemon
