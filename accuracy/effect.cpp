#include "stormcellar/accuracy/effect.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/nearest_name.h"
#include "base/printable.h"

namespace stormcellar::accuracy {
namespace {

constexpr std::size_t longest_name = 40;

tl::unexpected<Error> unknown_name(std::string_view name, const std::vector<std::string>& names) {
    if (names.empty()) {
        return fail(ErrorCode::bad_argument, "there is no effect \"{}\"; there are none here",
                    printable(name));
    }
    if (const auto nearest = nearest_name(name, names)) {
        return fail(ErrorCode::bad_argument, "there is no effect \"{}\"; did you mean \"{}\"?",
                    printable(name), *nearest);
    }
    return fail(ErrorCode::bad_argument, "there is no effect \"{}\"; the effects are {}",
                printable(name.substr(0, 2 * longest_name)), fmt::join(names, ", "));
}

}  // namespace

std::string_view name_of(Evidence evidence) {
    constexpr std::array<std::string_view, 3> names = {"exact", "proven", "sample"};
    return names[static_cast<std::size_t>(evidence)];
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

}  // namespace stormcellar::accuracy
