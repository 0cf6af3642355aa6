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
    // Decoded: UTF-8 without control characters. It begins with "/" and has no segment "." or "..",
    // and no doubled slash. A slash at the end stays. The prefix of [web] is removed.
    std::string path = "/";
    Fields query;        // decoded, in the order in which they were sent
    Fields headers;      // names as they were sent
    std::string client;  // the client's address, from the connection or from a trusted proxy
    // The address under which clients reach the server, without a slash at the end:
    // "http://127.0.0.1:8080" or "https://radar.example.org/storms".
    std::string base;

    // Returns the first parameter of this name; none if there is none.
    [[nodiscard]] std::optional<std::string_view> parameter(std::string_view name) const;
    // Returns all parameters of this name, in order.
    [[nodiscard]] std::vector<std::string_view> parameters(std::string_view name) const;
    // Returns the header of this name, compared without regard to case. Several headers of one name
    // count as one list, joined by ", ".
    [[nodiscard]] std::optional<std::string> header(std::string_view name) const;
    // Returns true if Accept-Encoding names the coding ("gzip", "zstd") with a weight above 0. "*"
    // does not count.
    [[nodiscard]] bool accepts(std::string_view coding) const;
    // Returns true if Accept weighs text/html above application/json, as browsers do. Returns false
    // without the header and for "*/*" alone.
    [[nodiscard]] bool prefers_html() const;
};

// Removes blanks and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

// Returns the segments between slashes: "/a/b/" and "/a/b" have "a" and "b".
[[nodiscard]] std::vector<std::string_view> segments_of(std::string_view path);

// Decodes %XX; none if a digit is missing, or if the decoded text is not UTF-8 or has a control
// character. `plus_is_space` is for queries.
[[nodiscard]] std::optional<std::string> decoded(std::string_view text, bool plus_is_space);
// Checks and decodes the path of a request line; none if it must be refused.
[[nodiscard]] std::optional<std::string> decoded_path(std::string_view target);
// Decodes "a=1&b=2"; none if a part cannot be decoded or there are more than `most` parts.
[[nodiscard]] std::optional<Fields> decoded_query(std::string_view text, std::size_t most = 256);
// Encodes for links: everything but letters, digits and "-._~" becomes %XX.
[[nodiscard]] std::string encoded(std::string_view text);

}  // namespace stormcellar::web
