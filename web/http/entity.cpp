// Answers conditional requests and ranges: RFC 9110 sections 13 and 14.
#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "web/http/answer.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t most_ranges = 16;

// Calls `take` with each item of a list with commas. Tags of this server contain no commas, but
// tags of other servers may.
template <class Take>
void each_item(std::string_view list, Take take) {
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        if (const auto item = trimmed(list.substr(0, comma)); !item.empty()) take(item);
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
}

bool names_tag(std::string_view list, std::string_view etag, bool weakly) {
    bool found = false;
    each_item(list, [&](std::string_view item) {
        if (weakly && item.starts_with("W/")) item.remove_prefix(2);
        std::string_view ours = etag;
        if (weakly && ours.starts_with("W/")) ours.remove_prefix(2);
        if (item == "*" || (item == ours && !item.empty() && !item.starts_with("W/"))) found = true;
    });
    return found;
}

// Returns the time in whole seconds, because dates of HTTP have no fractions.
std::optional<std::chrono::sys_seconds> seconds_of(std::optional<UtcTime> time) {
    if (!time) return std::nullopt;
    return std::chrono::floor<std::chrono::seconds>(*time);
}

bool is_not_modified(const Request& request, const Entity& entity) {
    if (const auto tags = request.header("If-None-Match"))
        return names_tag(*tags, entity.etag, true);
    const auto since = request.header("If-Modified-Since");
    const auto time = since ? parse_http_date(*since) : std::nullopt;
    return time && entity.modified && *seconds_of(entity.modified) <= *time;
}

bool fails_its_condition(const Request& request, const Entity& entity) {
    if (const auto tags = request.header("If-Match")) return !names_tag(*tags, entity.etag, false);
    const auto since = request.header("If-Unmodified-Since");
    const auto time = since ? parse_http_date(*since) : std::nullopt;
    return time && entity.modified && *seconds_of(entity.modified) > *time;
}

// Returns true if the client has this version, so that it may get a range (If-Range).
bool is_same_version(const Request& request, const Entity& entity) {
    const auto known = request.header("If-Range");
    if (!known) return true;
    if (known->find('"') != std::string::npos)
        return !entity.etag.empty() && !entity.etag.starts_with("W/") && *known == entity.etag;
    const auto time = parse_http_date(*known);
    return time && entity.modified && *seconds_of(entity.modified) == *time;
}

struct ByteRange {
    std::uint64_t first = 0, last = 0;  // both included
    [[nodiscard]] std::uint64_t size() const { return last - first + 1; }
};

std::optional<std::uint64_t> whole_number(std::string_view text) {
    std::uint64_t number = 0;
    if (text.empty()) return std::nullopt;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (end != text.data() + text.size()) {
        if (error == std::errc::result_out_of_range) return UINT64_MAX;
        return std::nullopt;
    }
    return error == std::errc{} ? number : UINT64_MAX;
}

struct Ranges {
    bool makes_sense = true;
    std::vector<ByteRange> parts;  // the ranges that are within the bytes
};

Ranges parse_ranges(std::string_view header, std::uint64_t size) {
    Ranges ranges;
    constexpr std::string_view unit = "bytes=";
    if (!header.starts_with(unit)) return {.makes_sense = false, .parts = {}};
    std::size_t count = 0;
    each_item(header.substr(unit.size()), [&](std::string_view item) {
        ++count;
        const std::size_t dash = item.find('-');
        if (dash == std::string_view::npos) {
            ranges.makes_sense = false;
            return;
        }
        const auto first = whole_number(item.substr(0, dash));
        const auto last = whole_number(item.substr(dash + 1));
        const bool has_first = dash > 0, has_last = dash + 1 < item.size();
        if ((has_first && !first) || (has_last && !last) || (!has_first && !has_last) ||
            (first && last && *first > *last)) {
            ranges.makes_sense = false;
        } else if (!has_first) {
            if (*last > 0 && size > 0)
                ranges.parts.push_back({size - std::min(*last, size), size - 1});
        } else if (*first < size) {
            ranges.parts.push_back({*first, std::min(last.value_or(size - 1), size - 1)});
        }
    });
    if (count == 0 || count > most_ranges) ranges.makes_sense = false;
    return ranges;
}

void add_common(Answer& answer, const Entity& entity) {
    if (!entity.etag.empty()) answer.with("ETag", entity.etag);
    if (entity.modified) answer.with("Last-Modified", http_date(*entity.modified));
    std::string caching = "no-cache";
    if (entity.max_age) {
        caching = fmt::format("max-age={}{}", entity.max_age->count(),
                              entity.never_changes ? ", immutable" : "");
    }
    answer.with("Cache-Control", caching);
    if (entity.varies) answer.with("Vary", "Accept-Encoding");
    for (const auto& [name, value] : entity.headers)
        answer.with(name, value);
}

Answer several_parts(const Entity& entity, const std::vector<ByteRange>& ranges) {
    constexpr std::string_view boundary = "stormcellar-part-5d1f0b7c93e246a8";
    const std::uint64_t size = size_of(entity.bytes);
    Answer answer;
    answer.status = 206;
    answer.with("Content-Type", fmt::format("multipart/byteranges; boundary={}", boundary));
    Pieces body;
    for (const ByteRange& range : ranges) {
        body.emplace_back(text_of(
            fmt::format("\r\n--{}\r\nContent-Type: {}\r\nContent-Range: bytes {}-{}/{}\r\n\r\n",
                        boundary, entity.content_type, range.first, range.last, size)));
        for (Piece& piece : part_of(entity.bytes, range.first, range.size()))
            body.push_back(std::move(piece));
    }
    body.emplace_back(text_of(fmt::format("\r\n--{}--\r\n", boundary)));
    answer.body = std::move(body);
    return answer;
}

// Returns true if the ranges together ask for more than the whole. This is an attack or a mistake,
// and the whole is sent instead.
bool asks_too_much(const std::vector<ByteRange>& ranges, std::uint64_t size) {
    std::uint64_t sum = 0;
    for (const ByteRange& range : ranges)
        sum += range.size();
    return sum > size;
}

std::optional<Answer> ranged(const Request& request, const Entity& entity) {
    const auto header = request.header("Range");
    if (!header || request.verb != Verb::get || !is_same_version(request, entity))
        return std::nullopt;
    const std::uint64_t size = size_of(entity.bytes);
    const Ranges ranges = parse_ranges(*header, size);
    if (!ranges.makes_sense) return std::nullopt;
    if (ranges.parts.empty()) {
        return sentence(416, fmt::format("There are {} bytes, and none in this range.", size))
            .with("Content-Range", fmt::format("bytes */{}", size));
    }
    if (ranges.parts.size() > 1) {
        if (asks_too_much(ranges.parts, size)) return std::nullopt;
        return several_parts(entity, ranges.parts);
    }
    const ByteRange& only = ranges.parts.front();
    Answer answer;
    answer.status = 206;
    answer.with("Content-Type", entity.content_type);
    answer.with("Content-Range", fmt::format("bytes {}-{}/{}", only.first, only.last, size));
    answer.body = part_of(entity.bytes, only.first, only.size());
    return answer;
}

}  // namespace

Answer answer_with(const Request& request, Entity entity) {
    if (fails_its_condition(request, entity))
        return sentence(412, "This is not the version that was asked for.");
    if (is_not_modified(request, entity)) {
        Answer answer;
        answer.status = 304;
        add_common(answer, entity);
        return answer;
    }
    Answer answer;
    if (auto part = ranged(request, entity)) {
        answer = *std::move(part);
        if (answer.status == 416) return answer;
    } else {
        answer.with("Content-Type", entity.content_type);
        answer.body = entity.bytes;
    }
    if (!entity.coding.empty()) answer.with("Content-Encoding", entity.coding);
    answer.with("Accept-Ranges", "bytes");
    add_common(answer, entity);
    return answer;
}

}  // namespace stormcellar::web
