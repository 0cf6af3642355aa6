#include "web/doors/thredds/w3c_times.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/printable.h"

namespace stormcellar::web {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr std::size_t longest_time_text = 64;
constexpr int most_years = 1000;

bool is_time_digit(char c) {
    return c >= '0' && c <= '9';
}

// Reads a text from its start, piece by piece.
class TimeText {
  public:
    explicit TimeText(std::string_view text) : rest_(text) {}
    [[nodiscard]] bool is_empty() const { return rest_.empty(); }
    [[nodiscard]] char next() const { return rest_.empty() ? '\0' : rest_.front(); }
    bool take(char letter) {
        if (next() != letter) return false;
        rest_.remove_prefix(1);
        return true;
    }
    // Reads exactly `digits` digits as a number from `least` to `most`.
    std::optional<int> number(std::size_t digits, int least, int most) {
        if (rest_.size() < digits) return std::nullopt;
        int value = 0;
        for (std::size_t i = 0; i < digits; ++i) {
            if (!is_time_digit(rest_[i])) return std::nullopt;
            value = 10 * value + (rest_[i] - '0');
        }
        rest_.remove_prefix(digits);
        return value >= least && value <= most ? std::optional{value} : std::nullopt;
    }
    // Reads a non-negative number with an optional fraction.
    std::optional<double> decimal() {
        if (!is_time_digit(next())) return std::nullopt;
        double value = 0;
        const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value,
                                                  std::chars_format::fixed);
        if (error != std::errc{}) return std::nullopt;
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return value;
    }
    // Reads the digits after a point as milliseconds. Drops digits after the third.
    std::optional<milliseconds> fraction() {
        int value = 0, digits = 0;
        for (; is_time_digit(next()); rest_.remove_prefix(1), ++digits)
            if (digits < 3) value = 10 * value + (next() - '0');
        if (digits == 0) return std::nullopt;
        for (int i = digits; i < 3; ++i)
            value *= 10;
        return milliseconds{value};
    }
    [[nodiscard]] std::string_view rest() const { return rest_; }

  private:
    std::string_view rest_;
};

// Reads a time of day such as "12", "12:30", "12:30:15" or "12:30:15.250".
std::optional<milliseconds> take_clock(TimeText& text) {
    const auto hour = text.number(2, 0, 24);
    if (!hour) return std::nullopt;
    milliseconds clock = hours{*hour};
    if (text.take(':')) {
        const auto minute = text.number(2, 0, 59);
        if (!minute) return std::nullopt;
        clock += minutes{*minute};
        if (text.take(':')) {
            const auto second = text.number(2, 0, 60);
            if (!second) return std::nullopt;
            clock += seconds{*second};
            if (text.take('.')) {
                const auto fraction = text.fraction();
                if (!fraction) return std::nullopt;
                clock += *fraction;
            }
        }
    }
    return clock <= days{1} ? std::optional{clock} : std::nullopt;
}

// Reads an offset: "Z", "+01:00", "-0500" or nothing. In a query, an unencoded '+' has become a
// space.
std::optional<minutes> take_offset(TimeText& text) {
    if (text.is_empty() || text.take('Z') || text.take('z')) return minutes{0};
    const bool is_west = text.take('-');
    if (!is_west && !text.take('+') && !text.take(' ')) return std::nullopt;
    const auto hour = text.number(2, 0, 14);
    if (!hour) return std::nullopt;
    (void)text.take(':');
    const auto minute = text.is_empty() ? std::optional{0} : text.number(2, 0, 59);
    if (!minute) return std::nullopt;
    const minutes offset = hours{*hour} + minutes{*minute};
    return is_west ? -offset : offset;
}

std::optional<UtcTime> time_of_w3c(TimeText text) {
    const auto year = text.number(4, 1900, 2199);
    if (!year) return std::nullopt;
    int month = 1, day = 1;
    milliseconds clock{0};
    minutes offset{0};
    if (text.take('-')) {
        const auto given = text.number(2, 1, 12);
        if (!given) return std::nullopt;
        month = *given;
        if (text.take('-')) {
            const auto of_month = text.number(2, 1, 31);
            if (!of_month) return std::nullopt;
            day = *of_month;
            if (text.take('T') || text.take('t') || text.take(' ')) {
                const auto given_clock = take_clock(text);
                if (!given_clock) return std::nullopt;
                clock = *given_clock;
                const auto given_offset = take_offset(text);
                if (!given_offset) return std::nullopt;
                offset = *given_offset;
            } else {
                (void)text.take('Z');
            }
        }
    }
    const std::chrono::year_month_day date{std::chrono::year{*year},
                                           std::chrono::month{static_cast<unsigned>(month)},
                                           std::chrono::day{static_cast<unsigned>(day)}};
    if (!text.is_empty() || !date.ok()) return std::nullopt;
    return std::chrono::sys_days{date} + clock - offset;
}

// A unit, as in "14 days". Months and years are counted in months; every other unit has a length.
struct TimeUnit {
    std::string_view name;
    milliseconds length;
    int months;
};
constexpr std::array<TimeUnit, 12> time_units = {{{"s", seconds{1}, 0},
                                                  {"sec", seconds{1}, 0},
                                                  {"second", seconds{1}, 0},
                                                  {"min", minutes{1}, 0},
                                                  {"minute", minutes{1}, 0},
                                                  {"h", hours{1}, 0},
                                                  {"hr", hours{1}, 0},
                                                  {"hour", hours{1}, 0},
                                                  {"day", days{1}, 0},
                                                  {"week", days{7}, 0},
                                                  {"month", {}, 1},
                                                  {"year", {}, 12}}};

bool is_unit(std::string_view text, std::string_view name) {
    return text == name || (text.size() == name.size() + 1 && text.starts_with(name) &&
                            text.back() == 's' && name.size() > 1);
}

// Adds a number of units. A fraction of a month has no fixed length, so it is refused.
bool add_units(W3cDuration& sum, double number, milliseconds length, int months) {
    if (months > 0) {
        if (number != std::floor(number) || number * months > most_years * 12) return false;
        sum.months += static_cast<int>(number) * months;
    } else {
        const double added = number * static_cast<double>(length.count());
        if (added > static_cast<double>(milliseconds{days{365'250}}.count())) return false;
        sum.rest += milliseconds{std::llround(added)};
    }
    return sum.months <= most_years * 12 && sum.rest <= days{365'250};
}

std::optional<W3cDuration> duration_in_words(TimeText text) {
    const auto number = text.decimal();
    if (!number) return std::nullopt;
    (void)text.take(' ');
    for (const TimeUnit& unit : time_units) {
        if (!is_unit(text.rest(), unit.name)) continue;
        W3cDuration duration;
        if (!add_units(duration, *number, unit.length, unit.months)) return std::nullopt;
        return duration;
    }
    return std::nullopt;
}

// Returns the unit of a letter in "P1Y2M3DT4H5M6S". M means months before the T, and minutes after
// it.
std::optional<TimeUnit> unit_of_letter(char letter, bool behind_t) {
    if (behind_t) {
        if (letter == 'H') return TimeUnit{"H", hours{1}, 0};
        if (letter == 'M') return TimeUnit{"M", minutes{1}, 0};
        if (letter == 'S') return TimeUnit{"S", seconds{1}, 0};
        return std::nullopt;
    }
    if (letter == 'Y') return TimeUnit{"Y", {}, 12};
    if (letter == 'M') return TimeUnit{"M", {}, 1};
    if (letter == 'W') return TimeUnit{"W", days{7}, 0};
    if (letter == 'D') return TimeUnit{"D", days{1}, 0};
    return std::nullopt;
}

std::optional<W3cDuration> duration_of_schema(TimeText text) {
    if (!text.take('P')) return std::nullopt;
    W3cDuration duration;
    bool behind_t = false, has_part = false;
    while (!text.is_empty()) {
        if (!behind_t && text.take('T')) {
            behind_t = true;
            has_part = false;
            continue;
        }
        const auto number = text.decimal();
        const auto unit = number ? unit_of_letter(text.next(), behind_t) : std::nullopt;
        if (!unit || !text.take(text.next())) return std::nullopt;
        if (!add_units(duration, *number, unit->length, unit->months)) return std::nullopt;
        has_part = true;
    }
    return has_part ? std::optional{duration} : std::nullopt;
}

UtcTime moved_by_months(UtcTime time, int months) {
    const auto day = std::chrono::floor<days>(time);
    const std::chrono::year_month_day date{day};
    const auto month =
        std::chrono::year_month{date.year(), date.month()} + std::chrono::months{months};
    const std::chrono::year_month_day_last last{month.year(),
                                                std::chrono::month_day_last{month.month()}};
    const std::chrono::year_month_day moved{month.year(), month.month(),
                                            std::min(date.day(), last.day())};
    return std::chrono::sys_days{moved} + (time - day);
}

}  // namespace

Result<UtcTime> parse_w3c_time(std::string_view text, UtcTime now) {
    if (text == "present") return now;
    const auto time = text.size() <= longest_time_text ? time_of_w3c(TimeText{text}) : std::nullopt;
    if (time) return *time;
    return fail(ErrorCode::bad_argument,
                "\"{}\" is not a time: give one such as 2022-03-17T00:08:00Z, or present.",
                printable(text.substr(0, longest_time_text)));
}

Result<W3cDuration> parse_w3c_duration(std::string_view text) {
    std::optional<W3cDuration> duration;
    if (text.size() <= longest_time_text) {
        duration = text.starts_with('P') ? duration_of_schema(TimeText{text})
                                         : duration_in_words(TimeText{text});
    }
    if (duration) return *duration;
    return fail(ErrorCode::bad_argument,
                "\"{}\" is not a duration: give one such as PT3H, P1D or 14 days.",
                printable(text.substr(0, longest_time_text)));
}

UtcTime later_by(UtcTime time, const W3cDuration& duration) {
    return moved_by_months(time, duration.months) + duration.rest;
}

UtcTime earlier_by(UtcTime time, const W3cDuration& duration) {
    return moved_by_months(time - duration.rest, -duration.months);
}

}  // namespace stormcellar::web
