#include "base/toml_depth.h"

#include <algorithm>
#include <string>

namespace stormcellar {
namespace {

bool is_quote(char c) {
    return c == '"' || c == '\'';
}

// Returns the position after the string that begins at `from`, or the position of an error in it.
std::size_t end_of_string(std::string_view toml, std::size_t from) {
    const char quote = toml[from];
    const std::string three(3, quote);
    const bool has_lines = toml.substr(from).starts_with(three);
    std::size_t at = from + (has_lines ? 3 : 1);
    for (; at < toml.size(); ++at) {
        if (toml[at] == '\\' && quote == '"') {
            ++at;  // skip the escaped character, too
        } else if (!has_lines && (toml[at] == quote || toml[at] == '\n')) {
            return at + (toml[at] == quote ? 1 : 0);
        } else if (has_lines && toml.substr(at).starts_with(three)) {
            // Up to two more quotes may come before the three that close it.
            for (at += 3; at < toml.size() && toml[at] == quote; ++at) {
            }
            return at;
        }
    }
    return toml.size();
}

}  // namespace

std::optional<unsigned> line_of_deep_key(std::string_view toml) {
    constexpr std::string_view between_keys = ",=[]{}\n";
    int dots = 0;
    for (std::size_t at = 0; at < toml.size();) {
        if (is_quote(toml[at])) {
            at = end_of_string(toml, at);
            continue;
        }
        if (toml[at] == '#') {
            at = std::min(toml.find('\n', at), toml.size());
            continue;
        }
        if (between_keys.find(toml[at]) != std::string_view::npos) dots = 0;
        if (toml[at] == '.' && ++dots >= most_key_parts)
            return 1U + static_cast<unsigned>(std::count(toml.begin(), toml.begin() + at, '\n'));
        ++at;
    }
    return std::nullopt;
}

}  // namespace stormcellar
