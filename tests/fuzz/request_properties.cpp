#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>

#include "tests/fuzz/properties.h"
#include "web/http/answer.h"
#include "web/http/read_request.h"

namespace stormcellar::fuzz {
namespace {

using web::Answer;
using web::Fields;
using web::Piece;
using web::Pieces;
using web::Request;

// Parses a request. The first line has the method and the target; each further line has a header.
web::RawRequest request_in(std::string_view text) {
    web::RawRequest raw;
    raw.client = "127.0.0.1";
    std::size_t count = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::size_t space = std::min(line.find(count == 0 ? ' ' : ':'), line.size());
        std::string first{line.substr(0, space)};
        std::string second{line.substr(std::min(space + 1, line.size()))};
        if (count++ == 0) {
            raw.method = std::move(first);
            raw.target = std::move(second);
        } else {
            raw.headers.emplace_back(std::move(first), std::move(second));
        }
    }
    return raw;
}

bool is_clean(std::string_view text) {
    return std::none_of(text.begin(), text.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7F;
    });
}

void check_path_and_query(const Request& request) {
    const std::string& path = request.path;
    require(path.starts_with('/'), "the path begins with another letter than '/'");
    require(path.find("//") == std::string::npos, "the path has a doubled slash");
    require(is_clean(path), "the path has a control character");
    for (const std::string_view segment : web::segments_of(path))
        require(segment != "." && segment != "..", "the path has a segment of dots");
    require(web::decoded(web::encoded(path), false) == path, "encoding the path is not undone");
    for (const auto& [name, value] : request.query)
        require(is_clean(name) && is_clean(value), "the query has a control character");
}

std::string bytes_of(const Answer& answer) {
    std::string all;
    for (const Piece& piece : std::get<Pieces>(answer.body))
        all += *std::get<web::Text>(piece);
    return all;
}

std::string header_of(const Answer& answer, std::string_view name) {
    for (const auto& [key, value] : answer.headers)
        if (key == name) return value;
    return {};
}

// Requires that the body has exactly the bytes that Content-Range names.
void check_part(const std::string& body, const std::string& content_range,
                const std::string& whole) {
    unsigned long long first = 0, last = 0, size = 0;
    const int fields =
        std::sscanf(content_range.c_str(), "bytes %llu-%llu/%llu", &first, &last, &size);
    require(fields == 3 && size == whole.size() && first <= last && last < size,
            "Content-Range is \"{}\"", content_range);
    require(body == std::string_view{whole}.substr(first, last - first + 1),
            "the body is not what Content-Range says");
}

// Checks the answer to a request for a file of two pieces.
void check_entity(const Request& request) {
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789";
    std::string whole;
    while (whole.size() < 1000)
        whole += letters;
    web::Entity entity;
    entity.bytes = {web::text_of(whole.substr(0, 300)), web::text_of(whole.substr(300))};
    entity.content_type = "text/plain";
    entity.etag = "\"abc\"";
    entity.modified = UtcTime{std::chrono::seconds{1'700'000'000}};
    const Answer answer = web::answer_with(request, std::move(entity));
    const std::string body = bytes_of(answer);
    constexpr std::array<unsigned, 5> statuses = {200, 206, 304, 412, 416};
    require(std::ranges::find(statuses, answer.status) != statuses.end(), "the status is {}",
            answer.status);
    for (const auto& [name, value] : answer.headers)
        require(is_clean(name) && is_clean(value), "a header has a control character");
    if (answer.status == 200) require(body == whole, "an answer of 200 is not the whole");
    if (answer.status == 304) require(body.empty(), "an answer of 304 has a body");
    if (answer.status != 206) return;
    const std::string range = header_of(answer, "Content-Range");
    if (!range.empty()) return check_part(body, range, whole);
    require(header_of(answer, "Content-Type").starts_with("multipart/byteranges"),
            "a 206 of several parts does not say so");
    // An answer has at most sixteen parts, and each part adds some lines.
    require(body.size() <= 16 * (whole.size() + 200) + 100, "the parts have {} bytes", body.size());
}

void check_dates(std::string_view text) {
    const auto time = web::parse_http_date(text);
    if (!time) return;
    const std::string again = web::http_date(*time);
    require(web::parse_http_date(again) == time, "the date \"{}\" is not read back", again);
}

}  // namespace

void check_request(std::span<const std::byte> input) {
    const std::string_view text{reinterpret_cast<const char*>(input.data()), input.size()};
    const web::RawRequest raw = request_in(text);
    web::ServerOptions options;
    options.names = {"radar.example.org"};
    options.trusted_proxies = {"127.0.0.1"};
    options.prefix = text.size() % 2 == 0 ? "" : "/storms";
    const auto reading = web::read_request(raw, web::identity_of(options));
    for (const auto& [name, value] : raw.headers)
        check_dates(value);
    require(web::xml_escaped(text.substr(0, 1000)).find_first_of("<>\"'") == std::string::npos,
            "escaped text has a letter of markup");
    if (reading.refusal) {
        require(reading.refusal->status >= 400 && reading.refusal->status < 600 &&
                    !reading.refusal->reason.empty(),
                "a refusal has the status {} or gives no reason", reading.refusal->status);
        return;
    }
    check_path_and_query(reading.request);
    require(is_clean(reading.request.base), "the address of the server has a control character");
    check_entity(reading.request);
}

}  // namespace stormcellar::fuzz
