#include "base/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <fmt/format.h>

namespace stormcellar {
namespace {

// Longer words do not count as misspellings, because the time for a distance grows with the product
// of both lengths.
constexpr std::size_t longest_word = 80;
// A misspelled word has at most one edit for this many letters of the name, and at least one edit
// is allowed.
constexpr std::size_t letters_per_slip = 3;

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

}  // namespace

// Computes the distance by optimal string alignment, with three rows of the table of prefixes.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> above(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::swap(before, above);
        std::swap(above, row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
    }
    return row[b.size()];
}

std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> names) {
    if (word.empty() || word.size() > longest_word) return std::nullopt;
    const std::string wanted = in_lower_case(word);
    std::optional<std::string> nearest;
    std::size_t least = 0;
    for (const std::string& name : names) {
        const std::size_t distance = edit_distance(wanted, in_lower_case(name));
        if (distance >= name.size()) continue;  // no letter of the name would remain
        if (distance > std::max<std::size_t>(1, name.size() / letters_per_slip)) continue;
        if (nearest && distance >= least) continue;
        nearest = name;
        least = distance;
    }
    return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> names) {
    const auto nearest = nearest_name(word, names);
    return nearest ? fmt::format("; did you mean '{}'?", *nearest) : std::string{};
}

}  // namespace stormcellar
