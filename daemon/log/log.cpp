#include "daemon/log/log.h"

#include <memory>
#include <vector>

#include "daemon/log/journal.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::daemon {
namespace {

constexpr const char* identifier = "stormcellard";

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

std::vector<JournalField> fields_of(LogLevel level, const About& about, std::string_view message,
                                    std::uint64_t held_back) {
    std::vector<JournalField> fields = {{"MESSAGE", std::string{message}},
                                        {"PRIORITY", std::string{priority_of(level)}},
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

void write(LogLevel level, const About& about, std::string_view message, std::uint64_t held_back) {
    const auto& journal = outlet().journal;
    if (journal && journal->send(journal_entry(fields_of(level, about, message, held_back))))
        return;
    write_log(level, message);
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

LogOutlet usual_outlet() {
    LogOutlet usual;
    if (stderr_is_journal()) usual.journal = journal_socket;
    return usual;
}

void set_up_logging(std::string_view level, LogOutlet to) {
    set_log_level(level);
    outlet().journal = to.journal.empty() ? nullptr : std::make_unique<Journal>(to.journal);
    const MutexLock lock(outlet().mutex);
    outlet().clock =
        to.clock ? std::move(to.clock) : [] { return std::chrono::steady_clock::now(); };
    outlet().limiter = {};
}

void log_line(LogLevel level, const About& about, std::string_view message) {
    if (!is_logged(level)) return;
    if (level != LogLevel::debug) {
        const MutexLock lock(outlet().mutex);
        if (!outlet().limiter.allow(about.event, subject_of(about), level, outlet().clock()))
            return;
    }
    write(level, about, message, 0);
}

namespace {

void log_held_back_until(SteadyTime::duration ahead) {
    std::vector<LineLimiter::HeldBack> all;
    {
        const MutexLock lock(outlet().mutex);
        all = outlet().limiter.take_held_back(outlet().clock() + ahead);
    }
    for (const LineLimiter::HeldBack& held : all) {
        if (!is_logged(held.level)) continue;
        write(held.level, about_of(held),
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
