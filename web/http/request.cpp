#include "web/http/request.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include <strings.h>

#include "base/printable.h"

namespace stormcellar::web {
namespace {

bool is_name(std::string_view text, std::string_view name) {
    return text.size() == name.size() && ::strncasecmp(text.data(), name.data(), name.size()) == 0;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// Returns true if the text is safe in logs, headers and pages: UTF-8 without control characters.
bool is_plain(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        if (length == 0) return false;
        const auto first = static_cast<unsigned char>(text[0]);
        if (first < 0x20 || first == 0x7F) return false;
        // U+0080 to U+009F are control characters, too.
        if (length == 2 && first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0)
            return false;
        text.remove_prefix(length);
    }
    return true;
}

// Returns the weight that an Accept header gives to a media type. The most specific range that
// matches the type counts; 0 if none does.
double weight_of_type(std::string_view list, std::string_view type, std::string_view subtype) {
    double weight = 0;
    int most_specific = 0;
    while (!list.empty()) {
        const std::string_view item = list.substr(0, list.find(','));
        list.remove_prefix(std::min(item.size() + 1, list.size()));
        const std::string_view range = trimmed(item.substr(0, item.find(';')));
        const std::size_t slash = std::min(range.find('/'), range.size());
        const std::string_view minor = range.substr(std::min(slash + 1, range.size()));
        const bool is_type = is_name(range.substr(0, slash), type);
        const int specific = is_type && is_name(minor, subtype) ? 3
                             : is_type && minor == "*"          ? 2
                             : range == "*/*"                   ? 1
                                                                : 0;
        if (specific <= most_specific) continue;
        most_specific = specific;
        weight = 1;
        const std::size_t at = item.find("q=");
        if (at != std::string_view::npos)
            std::from_chars(item.data() + at + 2, item.data() + item.size(), weight);
    }
    return weight;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
        text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
        text.remove_suffix(1);
    return text;
}

std::optional<std::string_view> Request::parameter(std::string_view name) const {
    const auto found = std::find_if(query.begin(), query.end(),
                                    [&](const auto& field) { return field.first == name; });
    if (found == query.end()) return std::nullopt;
    return found->second;
}

std::vector<std::string_view> Request::parameters(std::string_view name) const {
    std::vector<std::string_view> values;
    for (const auto& [key, value] : query)
        if (key == name) values.emplace_back(value);
    return values;
}

std::optional<std::string> Request::header(std::string_view name) const {
    std::optional<std::string> all;
    for (const auto& [key, value] : headers) {
        if (!is_name(key, name)) continue;
        all = all ? *all + ", " + value : value;
    }
    return all;
}

bool Request::accepts(std::string_view coding) const {
    const auto list = header("Accept-Encoding");
    if (!list) return false;
    std::string_view rest = *list;
    while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        std::string_view item = rest.substr(0, comma);
        rest.remove_prefix(std::min(comma + 1, rest.size()));
        const std::size_t semicolon = std::min(item.find(';'), item.size());
        if (!is_name(trimmed(item.substr(0, semicolon)), coding)) continue;
        // A weight refuses the coding only if all digits of the weight are 0.
        const std::string_view weight = item.substr(semicolon);
        const std::size_t equals = weight.find('=');
        if (equals == std::string_view::npos) return true;
        return weight.find_first_of("123456789", equals) != std::string_view::npos;
    }
    return false;
}

bool Request::prefers_html() const {
    const auto list = header("Accept");
    return list &&
           weight_of_type(*list, "text", "html") > weight_of_type(*list, "application", "json");
}

std::vector<std::string_view> segments_of(std::string_view path) {
    std::vector<std::string_view> segments;
    while (!path.empty()) {
        const std::size_t slash = std::min(path.find('/'), path.size());
        if (slash > 0) segments.push_back(path.substr(0, slash));
        path.remove_prefix(std::min(slash + 1, path.size()));
    }
    return segments;
}

std::optional<std::string> decoded(std::string_view text, bool plus_is_space) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '+' && plus_is_space) {
            out += ' ';
        } else if (text[i] == '%') {
            if (i + 2 >= text.size()) return std::nullopt;
            const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
            if (high < 0 || low < 0) return std::nullopt;
            out += static_cast<char>(high << 4 | low);
            i += 2;
        } else {
            out += text[i];
        }
    }
    if (!is_plain(out)) return std::nullopt;
    return out;
}

std::optional<std::string> decoded_path(std::string_view target) {
    // Refuse an encoded slash or backslash, because it would split a segment in two, here or in a
    // proxy.
    for (std::size_t i = 0; i + 2 < target.size(); ++i) {
        if (target[i] != '%') continue;
        const int code = hex_digit(target[i + 1]) * 16 + hex_digit(target[i + 2]);
        if (code == '/' || code == '\\') return std::nullopt;
    }
    const auto plain = decoded(target, false);
    if (!plain || plain->empty() || plain->front() != '/') return std::nullopt;
    if (plain->find('\\') != std::string::npos) return std::nullopt;
    std::string path;
    for (const std::string_view segment : segments_of(*plain)) {
        if (segment == "." || segment == "..") return std::nullopt;
        path += '/';
        path += segment;
    }
    if (path.empty() || plain->back() == '/') path += '/';
    return path;
}

std::optional<Fields> decoded_query(std::string_view text, std::size_t most) {
    Fields fields;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('&'), text.size());
        const std::string_view part = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (part.empty()) continue;
        const std::size_t equals = std::min(part.find('='), part.size());
        auto name = decoded(part.substr(0, equals), true);
        auto value = decoded(part.substr(std::min(equals + 1, part.size())), true);
        if (!name || !value || fields.size() == most) return std::nullopt;
        fields.emplace_back(*std::move(name), *std::move(value));
    }
    return fields;
}

std::string encoded(std::string_view text) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string out;
    for (const char c : text) {
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        const bool is_plain_digit = c >= '0' && c <= '9';
        if (is_letter || is_plain_digit || c == '-' || c == '.' || c == '_' || c == '~') {
            out += c;
        } else {
            out += '%';
            out += digits[static_cast<unsigned char>(c) >> 4];
            out += digits[static_cast<unsigned char>(c) & 15];
        }
    }
    return out;
}

}  // namespace stormcellar::web
