#include "stormcellar/accuracy/quantity.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace stormcellar::accuracy {
namespace {

constexpr int digits = 3;
// Numbers outside these limits are written with an exponent.
constexpr double smallest_plain = 1e-4;
constexpr double largest_plain = 1e7;
// Without this slack, rounding up the binary fraction nearest to 0.3 would give 0.301.
constexpr double digit_slack = 1e-12;

}  // namespace

std::string_view name_of(ValueUnit unit) {
    constexpr std::array<std::string_view, 7> names = {"dB",      "m/s",    "deg", "ratio",
                                                       "0.001/s", "deg/km", "mm/h"};
    return names[static_cast<std::size_t>(unit)];
}

double ErrorSize::of(Quantity quantity) const {
    return figure_of(quantity, position_m, value, image_de);
}

ErrorSize& ErrorSize::operator+=(const ErrorSize& other) {
    position_m += other.position_m;
    value += other.value;
    image_de += other.image_de;
    return *this;
}

bool is_unbounded(const ErrorSize& size) {
    return std::any_of(all_quantities.begin(), all_quantities.end(),
                       [&](Quantity quantity) { return std::isinf(size.of(quantity)); });
}

std::string format_number(double number) {
    if (std::isinf(number)) return "unbounded";
    if (std::isnan(number)) return "unknown";
    if (number == 0) return "0";
    int exponent = static_cast<int>(std::floor(std::log10(std::fabs(number))));
    // The scale for rounding up would overflow here, so round this number to the nearest.
    if (std::abs(exponent) > 290) return fmt::format("{:.3g}", number);
    const double scale = std::pow(10, digits - 1 - exponent);
    const double rounded = std::ceil(number * scale * (1 - digit_slack)) / scale;
    if (rounded < smallest_plain || rounded >= largest_plain) return fmt::format("{:.3g}", rounded);
    exponent = static_cast<int>(std::floor(std::log10(std::fabs(rounded)) + digit_slack));
    const int decimals = std::max(0, digits - 1 - exponent);
    std::string text = fmt::format("{:.{}f}", rounded, decimals);
    if (decimals > 0) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') text.pop_back();
    }
    return text;
}

std::string format_quantity(Quantity quantity, double size, ValueUnit unit) {
    if (std::isinf(size)) return format_number(size);
    switch (quantity) {
        case Quantity::position:
            return format_number(size) + " m";
        case Quantity::value:
            return fmt::format("{} {}", format_number(size), name_of(unit));
        case Quantity::image:
            break;
    }
    return "dE " + format_number(size);
}

std::string format_size(const ErrorSize& size, ValueUnit unit) {
    std::string text;
    for (const Quantity quantity : all_quantities) {
        if (size.of(quantity) == 0) continue;
        if (!text.empty()) text += ", ";
        text += format_quantity(quantity, size.of(quantity), unit);
    }
    return text.empty() ? "0" : text;
}

std::string format_seconds(double seconds) {
    if (seconds == 0) return "0 s";
    if (seconds < 1e-3) return format_number(seconds * 1e6) + " us";
    if (seconds < 1) return format_number(seconds * 1e3) + " ms";
    return format_number(seconds) + " s";
}

}  // namespace stormcellar::accuracy
