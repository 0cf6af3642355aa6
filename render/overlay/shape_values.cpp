#include "render/overlay/shape_values.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <string>

#include "base/printable.h"

namespace stormcellar::render {
namespace {

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

// Takes an offset such as -05:00 or +0930 off the end of a time, and returns it.
std::chrono::minutes take_offset(std::string& text) {
    const std::size_t sign = text.find_last_of("+-");
    const bool is_after_time = sign != std::string::npos && text.find(':') < sign;
    if (!is_after_time) return {};
    std::string digits = text.substr(sign + 1);
    std::erase(digits, ':');
    if (digits.size() != 4 || !std::ranges::all_of(digits, is_digit)) return {};
    const std::chrono::minutes offset{60 * std::stoi(digits.substr(0, 2)) +
                                      std::stoi(digits.substr(2))};
    const bool is_west = text[sign] == '-';
    text.resize(sign);
    return is_west ? -offset : offset;
}

}  // namespace

Result<grid::GeoPoint> shape_place(double latitude_deg, double longitude_deg) {
    const bool is_on_earth = std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 360;
    if (!is_on_earth)
        return fail(ErrorCode::corrupt, "{:g}, {:g} is no place", latitude_deg, longitude_deg);
    if (longitude_deg > 180) longitude_deg -= 360;
    if (longitude_deg < -180) longitude_deg += 360;
    return grid::GeoPoint{latitude_deg, longitude_deg};
}

std::string shape_label(std::string_view text) {
    constexpr int most_characters = 80;
    std::size_t end = 0;
    for (int i = 0; i < most_characters && end < text.size(); ++i)
        end += std::max<std::size_t>(1, utf8_length(text.substr(end)));
    return printable(text.substr(0, end));
}

Result<Rgba8> shape_color(std::string_view text) {
    const bool is_short = text.size() == 4;
    const auto wrong = [text] {
        return fail(ErrorCode::corrupt, "'{}' is no color such as #ff8800", printable(text));
    };
    if ((!is_short && text.size() != 7) || text.front() != '#') return wrong();
    Rgba8 color = {0, 0, 0, 255};
    const std::size_t digits = is_short ? 1 : 2;
    for (std::size_t i = 0; i < 3; ++i) {
        const char* begin = text.data() + 1 + i * digits;
        unsigned value = 0;
        const auto [end, problem] = std::from_chars(begin, begin + digits, value, 16);
        if (problem != std::errc{} || end != begin + digits) return wrong();
        color[i] = static_cast<std::uint8_t>(is_short ? 17 * value : value);
    }
    return color;
}

Result<UtcTime> shape_time(std::string_view text) {
    std::string plain(text);
    if (plain.size() == 12 && std::ranges::all_of(plain, is_digit))
        plain = plain.substr(0, 8) + "_" + plain.substr(8) + "00";
    const std::chrono::minutes offset = take_offset(plain);
    // parse_utc() also takes times relative to now, which a file cannot mean.
    const auto time = plain.empty() || !is_digit(plain.front())
                          ? Result<UtcTime>(fail(ErrorCode::corrupt, ""))
                          : parse_utc(plain, {});
    if (!time) return fail(ErrorCode::corrupt, "'{}' is no time", printable(text));
    return *time - offset;
}

}  // namespace stormcellar::render
