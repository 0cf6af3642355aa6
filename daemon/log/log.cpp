#include "daemon/log/log.h"

#include <cstdlib>
#include <memory>
#include <vector>

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/log/journal.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::daemon {
namespace {

constexpr const char* identifier = "stormcellard";

// Priorities of syslog(3): 7 debug, 6 info, 4 warning, 3 error.
int priority_of(spdlog::level::level_enum level) {
    switch (level) {
        case spdlog::level::trace:
        case spdlog::level::debug:
            return 7;
        case spdlog::level::info:
            return 6;
        case spdlog::level::warn:
            return 4;
        default:
            return 3;
    }
}

spdlog::level::level_enum level_of(Severity severity) {
    switch (severity) {
        case Severity::debug:
            return spdlog::level::debug;
        case Severity::info:
            return spdlog::level::info;
        case Severity::warning:
            return spdlog::level::warn;
        case Severity::error:
            return spdlog::level::err;
    }
    return spdlog::level::err;
}

class SyslogLevel final : public spdlog::custom_flag_formatter {
  public:
    void format(const spdlog::details::log_msg& message, const std::tm&,
                spdlog::memory_buf_t& line) override {
        fmt::format_to(std::back_inserter(line), "<{}>", priority_of(message.level));
    }
    [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
        return std::make_unique<SyslogLevel>();
    }
};

// The log of the process.
struct Outlet {
    std::unique_ptr<Journal> journal;
    Mutex mutex;
    std::function<SteadyTime()> clock STORMCELLAR_GUARDED_BY(mutex) = [] {
        return std::chrono::steady_clock::now();
    };
    LineLimiter limiter STORMCELLAR_GUARDED_BY(mutex);
};

Outlet& outlet() {
    static Outlet the_outlet;
    return the_outlet;
}

std::vector<JournalField> fields_of(Severity severity, const About& about, std::string_view message,
                                    std::uint64_t held_back) {
    std::vector<JournalField> fields = {
        {"MESSAGE", std::string{message}},
        {"PRIORITY", fmt::format("{}", priority_of(level_of(severity)))},
        {"SYSLOG_IDENTIFIER", identifier},
        {"STORMCELLAR_EVENT", std::string{name_of(about.event)}}};
    const auto add = [&](std::string_view name, std::string value) {
        if (!value.empty()) fields.push_back({name, std::move(value)});
    };
    add("STORMCELLAR_STATION", about.station);
    if (about.volume) add("STORMCELLAR_VOLUME", format_utc(*about.volume));
    add("STORMCELLAR_FILE", about.file.native());
    if (about.latency_s) add("STORMCELLAR_LATENCY_S", fmt::format("{:.3f}", *about.latency_s));
    if (about.took_s) add("STORMCELLAR_TOOK_S", fmt::format("{:.3f}", *about.took_s));
    add("STORMCELLAR_LOOP", about.loop);
    add("STORMCELLAR_DOMAIN", about.domain);
    add("STORMCELLAR_REASON", std::string{about.reason});
    if (held_back > 0) add("STORMCELLAR_HELD_BACK", fmt::format("{}", held_back));
    return fields;
}

void write(Severity severity, const About& about, std::string_view message,
           std::uint64_t held_back) {
    const auto& journal = outlet().journal;
    if (journal && journal->send(journal_entry(fields_of(severity, about, message, held_back))))
        return;
    spdlog::log(level_of(severity), "{}", message);
}

const std::string& subject_of(const About& about) {
    if (!about.station.empty()) return about.station;
    return about.loop.empty() ? about.domain : about.loop;
}

About about_of(const LineLimiter::HeldBack& held) {
    About about{.event = held.event};
    const std::string_view event = name_of(held.event);
    (event.starts_with("loop_")  ? about.loop
     : event.starts_with("site") ? about.domain
                                 : about.station) = held.subject;
    return about;
}

}  // namespace

bool stderr_is_journal() {
    const char* stream = std::getenv("JOURNAL_STREAM");
    struct stat facts {};
    if (stream == nullptr || ::fstat(STDERR_FILENO, &facts) != 0) return false;
    return fmt::format("{}:{}", facts.st_dev, facts.st_ino) == stream;
}

LogOutlet usual_outlet() {
    LogOutlet usual;
    if (stderr_is_journal()) usual.journal = journal_socket;
    return usual;
}

void set_up_logging(const std::string& level, LogOutlet to) {
    auto logger = std::make_shared<spdlog::logger>(
        identifier, std::make_shared<spdlog::sinks::stderr_sink_mt>());
    auto formatter = std::make_unique<spdlog::pattern_formatter>(
        stderr_is_journal() ? spdlog::pattern_time_type::local : spdlog::pattern_time_type::utc);
    formatter->add_flag<SyslogLevel>('*');
    formatter->set_pattern(stderr_is_journal() ? "%*%v" : "%Y-%m-%dT%H:%M:%S.%eZ %l: %v");
    logger->set_formatter(std::move(formatter));
    logger->flush_on(spdlog::level::debug);
    spdlog::set_default_logger(std::move(logger));
    set_log_level(level);
    outlet().journal = to.journal.empty() ? nullptr : std::make_unique<Journal>(to.journal);
    const MutexLock lock(outlet().mutex);
    outlet().clock =
        to.clock ? std::move(to.clock) : [] { return std::chrono::steady_clock::now(); };
    outlet().limiter = {};
}

void set_log_level(const std::string& level) {
    spdlog::set_level(spdlog::level::from_str(level));
}

void log_line(Severity severity, const About& about, std::string_view message) {
    if (!spdlog::should_log(level_of(severity))) return;
    if (severity != Severity::debug) {
        const MutexLock lock(outlet().mutex);
        if (!outlet().limiter.allow(about.event, subject_of(about), severity, outlet().clock()))
            return;
    }
    write(severity, about, message, 0);
}

namespace {

void log_held_back_until(SteadyTime::duration ahead) {
    std::vector<LineLimiter::HeldBack> all;
    {
        const MutexLock lock(outlet().mutex);
        all = outlet().limiter.take_held_back(outlet().clock() + ahead);
    }
    for (const LineLimiter::HeldBack& held : all) {
        if (!spdlog::should_log(level_of(held.severity))) continue;
        write(held.severity, about_of(held),
              fmt::format("{}{}{}: {} more lines like this were not logged in the last minute",
                          name_of(held.event), held.subject.empty() ? "" : " ", held.subject,
                          held.lines),
              held.lines);
    }
}

}  // namespace

void log_held_back() {
    log_held_back_until({});
}

void log_all_held_back() {
    log_held_back_until(LineLimiter::period);
}

}  // namespace stormcellar::daemon
