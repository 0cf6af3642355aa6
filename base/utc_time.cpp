#include "stormcellar/base/utc_time.h"

#include <optional>

#include <fmt/format.h>

#include "base/parse_number.h"

namespace stormcellar {
namespace {

using std::chrono::days;
using std::chrono::milliseconds;

// Parses exactly `width` digits at `position`; returns none if they are not there.
std::optional<int> digits(std::string_view text, std::size_t position, std::size_t width) {
    if (position + width > text.size()) return std::nullopt;
    int number = 0;
    for (const char c : text.substr(position, width)) {
        if (c < '0' || c > '9') return std::nullopt;
        number = number * 10 + (c - '0');
    }
    return number;
}

std::optional<UtcTime> make_time(int year, int month, int day, int hour, int minute, int second,
                                 int millisecond) {
    const std::chrono::year_month_day date{std::chrono::year{year},
                                           std::chrono::month{static_cast<unsigned>(month)},
                                           std::chrono::day{static_cast<unsigned>(day)}};
    if (!date.ok() || hour > 23 || minute > 59 || second > 59) return std::nullopt;
    return UtcTime{std::chrono::sys_days{date}} + std::chrono::hours{hour} +
           std::chrono::minutes{minute} + std::chrono::seconds{second} + milliseconds{millisecond};
}

// Parses the fraction after the seconds, ".5" or ".596", as milliseconds. Further digits are
// dropped.
std::optional<int> fraction_ms(std::string_view text) {
    if (text.size() < 2 || text[0] != '.') return std::nullopt;
    int number = 0;
    int weight = 100;
    for (const char c : text.substr(1)) {
        if (c < '0' || c > '9') return std::nullopt;
        number += (c - '0') * weight;
        weight /= 10;
    }
    return number;
}

std::optional<UtcTime> parse_iso(std::string_view text) {
    if (text.ends_with('Z')) text.remove_suffix(1);
    const auto year = digits(text, 0, 4);
    const auto month = digits(text, 5, 2);
    const auto day = digits(text, 8, 2);
    if (!year || !month || !day || text[4] != '-' || text[7] != '-') return std::nullopt;
    if (text.size() == 10) return make_time(*year, *month, *day, 0, 0, 0, 0);

    const auto hour = digits(text, 11, 2);
    const auto minute = digits(text, 14, 2);
    if (!hour || !minute || (text[10] != 'T' && text[10] != ' ') || text[13] != ':') {
        return std::nullopt;
    }
    if (text.size() == 16) return make_time(*year, *month, *day, *hour, *minute, 0, 0);

    const auto second = digits(text, 17, 2);
    if (!second || text[16] != ':') return std::nullopt;
    if (text.size() == 19) return make_time(*year, *month, *day, *hour, *minute, *second, 0);
    const auto millisecond = fraction_ms(text.substr(19));
    if (!millisecond) return std::nullopt;
    return make_time(*year, *month, *day, *hour, *minute, *second, *millisecond);
}

// Parses "-90m" as milliseconds before now.
std::optional<milliseconds> parse_relative(std::string_view text) {
    if (text.size() < 3 || text.front() != '-') return std::nullopt;
    const char unit = text.back();
    const std::string_view number_text = text.substr(1, text.size() - 2);
    const auto number = parse_number<std::uint32_t>(number_text);
    if (!number) return std::nullopt;
    switch (unit) {
        case 's':
            return std::chrono::seconds{*number};
        case 'm':
            return std::chrono::minutes{*number};
        case 'h':
            return std::chrono::hours{*number};
        case 'd':
            return days{*number};
        default:
            return std::nullopt;
    }
}

std::optional<UtcTime> compact(std::string_view text) {
    if (text.size() != 15 || text[8] != '_') return std::nullopt;
    const auto year = digits(text, 0, 4);
    const auto month = digits(text, 4, 2);
    const auto day = digits(text, 6, 2);
    const auto hour = digits(text, 9, 2);
    const auto minute = digits(text, 11, 2);
    const auto second = digits(text, 13, 2);
    if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
    return make_time(*year, *month, *day, *hour, *minute, *second, 0);
}

struct Civil {
    int year;
    unsigned month, day;
    std::chrono::hh_mm_ss<milliseconds> time;
};

Civil civil(UtcTime time) {
    const auto midnight = std::chrono::floor<days>(time);
    const std::chrono::year_month_day date{midnight};
    return {static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
            static_cast<unsigned>(date.day()),
            std::chrono::hh_mm_ss<milliseconds>{time - midnight}};
}

}  // namespace

UtcTime now_utc() {
    return std::chrono::floor<milliseconds>(std::chrono::system_clock::now());
}

UtcTime time_from_nexrad(std::uint32_t day, std::uint32_t ms) {
    return UtcTime{milliseconds{(std::int64_t{day} - 1) * 86'400'000 + std::int64_t{ms}}};
}

NexradTime nexrad_from_time(UtcTime time) {
    const std::int64_t total = time.time_since_epoch().count();
    if (total < 0) return {};
    return {static_cast<std::uint32_t>(total / 86'400'000 + 1),
            static_cast<std::uint32_t>(total % 86'400'000)};
}

std::string format_utc(UtcTime time) {
    const Civil c = civil(time);
    std::string text =
        fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", c.year, c.month, c.day,
                    c.time.hours().count(), c.time.minutes().count(), c.time.seconds().count());
    if (c.time.subseconds().count() != 0) {
        text += fmt::format(".{:03}", c.time.subseconds().count());
    }
    return text + "Z";
}

std::string format_compact(UtcTime time) {
    const Civil c = civil(time);
    return fmt::format("{:04}{:02}{:02}_{:02}{:02}{:02}", c.year, c.month, c.day,
                       c.time.hours().count(), c.time.minutes().count(), c.time.seconds().count());
}

Result<UtcTime> parse_utc(std::string_view text, UtcTime now) {
    if (text == "now") return now;
    if (const auto before = parse_relative(text)) return now - *before;
    if (const auto time = parse_iso(text)) return *time;
    if (const auto time = compact(text)) return *time;
    return fail(ErrorCode::bad_argument,
                "'{}' is not a time: use UTC as 2022-03-17T00:08:42Z or 2022-03-17, 'now', or a "
                "time before now such as -90m, -1h or -2d",
                text);
}

Result<UtcTime> parse_compact(std::string_view text) {
    if (const auto time = compact(text)) return *time;
    return fail(ErrorCode::bad_argument, "'{}' is not a time of the form YYYYMMDD_HHMMSS", text);
}

}  // namespace stormcellar
