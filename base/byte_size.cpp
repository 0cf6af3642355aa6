#include "base/byte_size.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "base/printable.h"

namespace stormcellar {
namespace {

constexpr double too_much = 9223372036854775808.0;  // 2^63

std::optional<double> unit_of(std::string_view name) {
    constexpr double kibi = 1024;
    static constexpr std::array<std::pair<std::string_view, double>, 10> units = {
        {{"", 1},
         {"b", 1},
         {"kb", 1e3},
         {"mb", 1e6},
         {"gb", 1e9},
         {"tb", 1e12},
         {"kib", kibi},
         {"mib", kibi * kibi},
         {"gib", kibi * kibi * kibi},
         {"tib", kibi * kibi * kibi * kibi}}};
    std::string lower(name);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    const auto found = std::find_if(units.begin(), units.end(),
                                    [&](const auto& unit) { return unit.first == lower; });
    if (found == units.end()) return std::nullopt;
    return found->second;
}

}  // namespace

Result<std::uint64_t> parse_byte_size(std::string_view text) {
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [after, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
    std::string_view unit(after, static_cast<std::size_t>(end - after));
    unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
    const std::optional<double> factor = unit_of(unit);
    if (error != std::errc{} || !factor || !(number >= 0 && number * *factor < too_much)) {
        return fail(ErrorCode::bad_argument,
                    "'{}' is not an amount of bytes such as 20 GB, 512 MiB or 0", printable(text));
    }
    return static_cast<std::uint64_t>(number * *factor);
}

std::string format_byte_size(std::uint64_t bytes) {
    static constexpr std::array<std::string_view, 4> units = {"kB", "MB", "GB", "TB"};
    if (bytes < 1000) return fmt::format("{} B", bytes);
    double number = static_cast<double>(bytes) / 1000;
    std::size_t unit = 0;
    while (number >= 999.5 && unit + 1 < units.size()) {
        number /= 1000;
        ++unit;
    }
    const int decimals = number < 9.995 ? 2 : number < 99.95 ? 1 : 0;
    return fmt::format("{:.{}f} {}", number, decimals, units[unit]);
}

}  // namespace stormcellar
