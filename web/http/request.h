// web/http/request.h -- a request after the server has checked and decoded it.
//
// Threads   A request is a plain value; all functions are pure.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stormcellar::web {

enum class Verb { get, head, options };

using Fields = std::vector<std::pair<std::string, std::string>>;

struct Request {
    Verb verb = Verb::get;
    // The decoded path, in UTF-8 without control characters. It begins with "/", and has no segment
    // "." or ".." and no doubled slash. A slash at the end stays. The prefix of [web] is removed.
    std::string path = "/";
    Fields query;        // decoded, in the order in which they were sent
    Fields headers;      // names are as they were sent
    std::string client;  // address of the client: the connection's, or from a trusted proxy
    // The address under which clients reach the server, without a slash at the end:
    // "http://127.0.0.1:8080" or "https://radar.example.org/storms".
    std::string base;

    // Returns the first parameter of this name, or none.
    [[nodiscard]] std::optional<std::string_view> parameter(std::string_view name) const;
    // Returns all parameters of this name, in order.
    [[nodiscard]] std::vector<std::string_view> parameters(std::string_view name) const;
    // Returns the header of this name; case does not matter. Several headers of one name count as
    // one list, joined by ", ".
    [[nodiscard]] std::optional<std::string> header(std::string_view name) const;
    // Returns true if Accept-Encoding names the coding ("gzip", "zstd") with a weight above 0. A
    // "*" does not count.
    [[nodiscard]] bool accepts(std::string_view coding) const;
    // Returns true if Accept gives text/html a greater weight than application/json, as browsers
    // do. Returns false if there is no such header, or if it is only "*/*".
    [[nodiscard]] bool prefers_html() const;
};

// Removes blanks and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

// Returns the segments between slashes. Both "/a/b/" and "/a/b" have the segments "a" and "b".
[[nodiscard]] std::vector<std::string_view> segments_of(std::string_view path);

// Decodes %XX. Returns none if a digit is missing, if the decoded text is not UTF-8, or if it has a
// control character. Set `plus_is_space` for queries.
[[nodiscard]] std::optional<std::string> decoded(std::string_view text, bool plus_is_space);
// Checks and decodes the path of a request line. Returns none if it must be refused.
[[nodiscard]] std::optional<std::string> decoded_path(std::string_view target);
// Decodes a query such as "a=1&b=2". Returns none if a part cannot be decoded, or if there are more
// than `most` parts.
[[nodiscard]] std::optional<Fields> decoded_query(std::string_view text, std::size_t most = 256);
// Encodes a text for links: everything but letters, digits and "-._~" becomes %XX.
[[nodiscard]] std::string encoded(std::string_view text);

}  // namespace stormcellar::web
