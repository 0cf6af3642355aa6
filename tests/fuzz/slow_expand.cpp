#include "tests/fuzz/slow_expand.h"

#include <algorithm>
#include <deque>
#include <vector>

namespace stormcellar::fuzz {
namespace {

using level2::CompressEnd;

constexpr std::size_t clear_code = 256;

// Takes the next group off `rest`, and returns its codes: eight, or fewer at the end.
std::deque<std::size_t> cut_group(std::span<const std::byte>& rest, std::size_t width) {
    const auto group = rest.first(std::min(rest.size(), width));
    rest = rest.subspan(group.size());
    std::vector<bool> bits;
    for (const std::byte byte : group) {
        for (int bit = 0; bit < 8; ++bit)
            bits.push_back(((byte >> bit) & std::byte{1}) != std::byte{0});
    }
    std::deque<std::size_t> codes;
    for (std::size_t at = 0; at + width <= bits.size(); at += width) {
        std::size_t code = 0;
        for (std::size_t bit = 0; bit < width; ++bit)
            code |= (bits[at + bit] ? std::size_t{1} : 0) << bit;
        codes.push_back(code);
    }
    return codes;
}

// Returns the first strings of the table. The clear code has an empty string.
std::vector<std::string> first_table(bool clears) {
    std::vector<std::string> table;
    for (int character = 0; character < 256; ++character)
        table.emplace_back(1, static_cast<char>(character));
    if (clears) table.emplace_back();
    return table;
}

}  // namespace

Expanded slow_expand(std::span<const std::byte> file, std::size_t limit) {
    if (file.size() < 3) return {{}, CompressEnd::truncated};
    const std::size_t most_width = std::to_integer<std::size_t>(file[2]) & 31U;
    const bool clears = (file[2] & std::byte{0x80}) != std::byte{0};
    if (most_width < 9 || most_width > 16) return {{}, CompressEnd::corrupt};
    const std::size_t most_entries = std::size_t{1} << most_width;
    std::span<const std::byte> rest = file.subspan(3);
    std::vector<std::string> table = first_table(clears);
    std::deque<std::size_t> codes;
    std::string previous;
    std::size_t width = 9;
    Expanded expanded;
    while (expanded.text.size() <= limit) {
        if (table.size() >= (std::size_t{1} << width) &&
            width < std::max<std::size_t>(most_width, 10)) {
            ++width;
            codes.clear();
        }
        if (codes.empty()) codes = cut_group(rest, width);
        if (codes.empty()) {
            expanded.end = CompressEnd::whole;
            return expanded;
        }
        const std::size_t code = codes.front();
        codes.pop_front();
        if (clears && code == clear_code) {
            table = first_table(clears);
            width = 9;
            codes.clear();
            previous.clear();
            continue;
        }
        const bool may_enter = !previous.empty() && table.size() < most_entries;
        std::string string;
        if (code < table.size() && (code < 256 || !previous.empty())) {
            string = table[code];
        } else if (may_enter && code == table.size()) {
            string = previous + previous.front();
        } else {
            expanded.end = CompressEnd::corrupt;
            return expanded;
        }
        if (may_enter) table.push_back(previous + string.front());
        expanded.text += string;
        previous = string;
    }
    return expanded;
}

}  // namespace stormcellar::fuzz
