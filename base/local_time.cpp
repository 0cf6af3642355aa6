#include "base/local_time.h"

#include <chrono>
#include <cstdlib>
#include <exception>

#include <date/tz.h>

namespace stormcellar {

// Converts the library's exceptions (no database, no such zone) to errors.
Result<std::string> format_local(UtcTime time, std::string_view zone) {
    const date::time_zone* found = nullptr;
    try {
        static_cast<void>(date::get_tzdb());
    } catch (const std::exception& error) {
        return fail(ErrorCode::unsupported, "time zones cannot be read: {}", error.what());
    }
    try {
        found = date::locate_zone(std::string(zone));
    } catch (const std::exception&) {
        return fail(
            ErrorCode::bad_argument,
            "{}: there is no time zone of this name; a name is, for example, America/Chicago",
            zone);
    }
    try {
        const auto seconds = std::chrono::floor<std::chrono::seconds>(
            std::chrono::sys_time<std::chrono::milliseconds>(time.time_since_epoch()));
        const date::sys_info info = found->get_info(seconds);
        const auto local = seconds + info.offset;
        const auto day = date::floor<date::days>(local);
        const date::year_month_day date(day);
        const date::hh_mm_ss clock(local - day);
        return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02} {}", static_cast<int>(date.year()),
                           static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                           clock.hours().count(), clock.minutes().count(), clock.seconds().count(),
                           info.abbrev);
    } catch (const std::exception& error) {
        return fail(ErrorCode::unsupported, "{}: {}", zone, error.what());
    }
}

std::string machine_time_zone() {
    if (const char* named = std::getenv("TZ"); named != nullptr && *named != '\0') {
        const std::string_view name = *named == ':' ? named + 1 : named;
        return format_local(UtcTime{}, name) ? std::string(name) : std::string{};
    }
    try {
        return date::current_zone()->name();
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace stormcellar
