#include "stormcellar/accuracy/effect.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/printable.h"

namespace stormcellar::accuracy {
namespace {

constexpr std::size_t longest_name = 40;
// A word that differs from every name by more than this share of its letters is no misspelling.
constexpr std::size_t letters_per_slip = 3;

tl::unexpected<Error> unknown_name(std::string_view name, const std::vector<std::string>& names) {
    if (names.empty()) {
        return fail(ErrorCode::bad_argument, "there is no effect \"{}\"; there are none here",
                    printable(name));
    }
    // A long word is no misspelling, and the distance takes time by the product of the lengths.
    if (name.size() <= 2 * longest_name) {
        const auto nearest = std::min_element(
            names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
                return edit_distance(name, a) < edit_distance(name, b);
            });
        if (edit_distance(name, *nearest) <=
            std::max<std::size_t>(1, nearest->size() / letters_per_slip)) {
            return fail(ErrorCode::bad_argument, "there is no effect \"{}\"; did you mean \"{}\"?",
                        printable(name), *nearest);
        }
    }
    return fail(ErrorCode::bad_argument, "there is no effect \"{}\"; the effects are {}",
                printable(name.substr(0, 2 * longest_name)), fmt::join(names, ", "));
}

}  // namespace

std::string_view name_of(Evidence evidence) {
    switch (evidence) {
        case Evidence::exact:
            return "exact";
        case Evidence::proven_bound:
            return "proven";
        case Evidence::sample:
            break;
    }
    return "sample";
}

Effect make_effect(std::string name, std::string rung, std::string what, double effort) {
    Effect made;
    made.name = std::move(name);
    made.rung = std::move(rung);
    made.what = std::move(what);
    made.effort = effort;
    return made;
}

bool is_effect_name(std::string_view name) {
    if (name.empty() || name.size() > longest_name) return false;
    if (name.front() < 'a' || name.front() > 'z' || name.back() == '_') return false;
    char previous = 0;
    for (const char c : name) {
        const bool allowed = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
        if (!allowed || (c == '_' && previous == '_')) return false;
        previous = c;
    }
    return true;
}

Result<EffectOverride> parse_override(std::string_view text,
                                      const std::vector<std::string>& names) {
    const std::size_t equals = text.find('=');
    const std::string_view name = text.substr(0, equals);
    if (equals == std::string_view::npos || name.empty()) {
        return fail(ErrorCode::bad_argument, "\"{}\" is not of the form NAME=on|off|auto",
                    printable(text.substr(0, 2 * longest_name)));
    }
    if (std::find(names.begin(), names.end(), name) == names.end()) {
        return unknown_name(name, names);
    }
    const std::string_view word = text.substr(equals + 1);
    if (word == "on") return EffectOverride{std::string(name), Setting::on};
    if (word == "off") return EffectOverride{std::string(name), Setting::off};
    if (word == "auto") return EffectOverride{std::string(name), Setting::automatic};
    return fail(ErrorCode::bad_argument, "effect {} can be on, off or auto, not \"{}\"", name,
                printable(word.substr(0, 2 * longest_name)));
}

// The distance by optimal string alignment, with three rows of the table of prefixes.
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

}  // namespace stormcellar::accuracy
