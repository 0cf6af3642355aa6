#include "base/number_list.h"

#include <charconv>
#include <cmath>

namespace stormcellar {

std::optional<std::vector<double>> parse_numbers(std::string_view text, char separator) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        double number = 0;
        const auto [stopped, error] = std::from_chars(at, end, number);
        if (error != std::errc{} || !std::isfinite(number)) return std::nullopt;
        numbers.push_back(number);
        if (stopped == end) return numbers;
        if (*stopped != separator) return std::nullopt;
        at = stopped + 1;
    }
}

}  // namespace stormcellar
