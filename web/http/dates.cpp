// Reads and writes the dates of HTTP, RFC 9110 section 5.6.7.
#include <array>
#include <cstdio>
#include <ctime>

#include <fmt/format.h>

#include "web/http/answer.h"

namespace stormcellar::web {
namespace {

constexpr std::array<const char*, 7> week_days = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
constexpr std::array<std::string_view, 12> month_names = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                          "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

struct DateParts {
    int day = 0, year = 0, hour = 0, minute = 0, second = 0;
    std::array<char, 4> month{};
};

std::optional<UtcTime> time_of(const DateParts& parts) {
    unsigned month = 0;
    for (unsigned i = 0; i < month_names.size(); ++i)
        if (month_names[i] == parts.month.data()) month = i + 1;
    const std::chrono::year_month_day date{std::chrono::year{parts.year}, std::chrono::month{month},
                                           std::chrono::day{static_cast<unsigned>(parts.day)}};
    const bool fits = parts.hour >= 0 && parts.hour < 24 && parts.minute >= 0 &&
                      parts.minute < 60 && parts.second >= 0 && parts.second <= 60;
    if (!date.ok() || !fits || parts.year < 1601 || parts.year > 9999) return std::nullopt;
    return std::chrono::sys_days{date} + std::chrono::hours{parts.hour} +
           std::chrono::minutes{parts.minute} + std::chrono::seconds{parts.second};
}

}  // namespace

std::string http_date(UtcTime time) {
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date{day};
    const std::chrono::hh_mm_ss clock{std::chrono::floor<std::chrono::seconds>(time - day)};
    return fmt::format(
        "{}, {:02} {} {:04} {:02}:{:02}:{:02} GMT",
        week_days[std::chrono::weekday{day}.c_encoding()], static_cast<unsigned>(date.day()),
        month_names[static_cast<unsigned>(date.month()) - 1], static_cast<int>(date.year()),
        clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

std::optional<UtcTime> parse_http_date(std::string_view text) {
    if (text.size() > 40) return std::nullopt;
    const std::string line(text);
    DateParts parts;
    int used = 0;
    const auto is_whole = [&] { return used == static_cast<int>(line.size()); };
    // No number has more than four digits, so none overflows. NOLINTBEGIN(cert-err34-c)
    // Sun, 06 Nov 1994 08:49:37 GMT
    if (std::sscanf(line.c_str(), "%*3[A-Za-z], %2d %3[A-Za-z] %4d %2d:%2d:%2d GMT%n", &parts.day,
                    parts.month.data(), &parts.year, &parts.hour, &parts.minute, &parts.second,
                    &used) == 6 &&
        is_whole())
        return time_of(parts);
    // Sunday, 06-Nov-94 08:49:37 GMT. A year that is more than 50 years ahead means the past
    // century.
    used = 0;
    if (std::sscanf(line.c_str(), "%*9[A-Za-z], %2d-%3[A-Za-z]-%2d %2d:%2d:%2d GMT%n", &parts.day,
                    parts.month.data(), &parts.year, &parts.hour, &parts.minute, &parts.second,
                    &used) == 6 &&
        is_whole()) {
        const int now = static_cast<int>(
            std::chrono::year_month_day{std::chrono::floor<std::chrono::days>(now_utc())}.year());
        parts.year += now - now % 100;
        if (parts.year > now + 50) parts.year -= 100;
        return time_of(parts);
    }
    // Sun Nov  6 08:49:37 1994
    used = 0;
    if (std::sscanf(line.c_str(), "%*3[A-Za-z] %3[A-Za-z] %2d %2d:%2d:%2d %4d%n",
                    parts.month.data(), &parts.day, &parts.hour, &parts.minute, &parts.second,
                    &parts.year, &used) == 6 &&
        is_whole())
        return time_of(parts);
    // NOLINTEND(cert-err34-c)
    return std::nullopt;
}

}  // namespace stormcellar::web
