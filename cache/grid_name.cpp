#include "stormcellar/cache/grid_name.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

namespace stormcellar::cache {
namespace {

constexpr std::string_view extension = ".scg";

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_capital(char c) {
    return c >= 'A' && c <= 'Z';
}
bool is_alphanumeric(char c) {
    return is_digit(c) || is_capital(c) || (c >= 'a' && c <= 'z');
}

bool is_icao(std::string_view name) {
    return name.size() == 4 && is_capital(name.front()) &&
           std::all_of(name.begin(), name.end(),
                       [](char c) { return is_capital(c) || is_digit(c); });
}

std::string stem_prefix(std::string_view domain, level2::Moment moment) {
    return fmt::format("{}_{}_", domain, level2::moment_name(moment));
}

std::string file_name(std::string_view domain, level2::Moment moment, UtcTime time) {
    const auto milliseconds = time - std::chrono::floor<std::chrono::seconds>(time);
    return fmt::format("{}{}_{:03}{}", stem_prefix(domain, moment), format_compact(time),
                       milliseconds.count(), extension);
}

}  // namespace

bool is_domain_name(std::string_view name) {
    const std::string_view group = group_of(name);
    const bool good_group =
        !group.empty() && group.size() <= 64 && is_alphanumeric(group.front()) &&
        std::all_of(group.begin(), group.end(),
                    [](char c) { return is_alphanumeric(c) || c == '_' || c == '-'; });
    return good_group && (!is_part(name) || is_icao(name.substr(group.size() + 1)));
}

std::string_view group_of(std::string_view domain) {
    return domain.substr(0, domain.find('.'));
}

bool is_part(std::string_view domain) {
    return domain.find('.') != std::string_view::npos;
}

bool is_possible(UtcTime time) {
    return UtcTime{} <= time && time <= last_possible_time;
}

bool is_day_name(std::string_view name) {
    return name.size() == 8 && std::all_of(name.begin(), name.end(), is_digit);
}

std::string day_name(UtcTime time) {
    return format_compact(time).substr(0, 8);
}

std::filesystem::path relative_path(const GridName& name) {
    return std::filesystem::path(name.domain) / std::string(level2::moment_name(name.moment)) /
           day_name(name.time) / file_name(name.domain, name.moment, name.time);
}

std::optional<UtcTime> time_in_file_name(std::string_view domain, level2::Moment moment,
                                         std::string_view name) {
    const std::string prefix = stem_prefix(domain, moment);
    constexpr std::size_t seconds_length = 15;  // YYYYMMDD_HHMMSS
    if (!name.starts_with(prefix) ||
        name.size() != prefix.size() + seconds_length + 4 + extension.size()) {
        return std::nullopt;
    }
    const Result<UtcTime> seconds = parse_compact(name.substr(prefix.size(), seconds_length));
    if (!seconds) return std::nullopt;
    int milliseconds = 0;
    for (const char c : name.substr(prefix.size() + seconds_length + 1, 3)) {
        if (!is_digit(c)) return std::nullopt;
        milliseconds = milliseconds * 10 + (c - '0');
    }
    const UtcTime time = *seconds + std::chrono::milliseconds{milliseconds};
    if (!is_possible(time) || file_name(domain, moment, time) != name) return std::nullopt;
    return time;
}

}  // namespace stormcellar::cache
