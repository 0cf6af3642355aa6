// base/parse_number.h -- reads a number that takes up a whole text.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace stormcellar {

// Reads a number as std::from_chars() does. Returns none if the text is empty, if something stands
// before or after the number, or if the number does not fit.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || stopped != end) return std::nullopt;
    return number;
}

// Reads a number from 0 on in its only form: without zeros before it.
[[nodiscard]] inline std::optional<std::size_t> parse_index(std::string_view text) {
    if (text.size() > 1 && text.starts_with('0')) return std::nullopt;
    return parse_number<std::size_t>(text);
}

}  // namespace stormcellar
