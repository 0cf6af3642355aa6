// web/http/answer.h -- the answers that the server sends.
//
// Threads   Plain values. The data that they share are constant, except for a Stream, which locks
//           itself.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "web/http/request.h"

namespace stormcellar::web {

using Text = std::shared_ptr<const std::string>;  // bytes in memory
[[nodiscard]] inline Text text_of(std::string bytes) {
    return std::make_shared<const std::string>(std::move(bytes));
}

// A part of a file, which is read while it is sent. If the file is truncated meanwhile, the server
// closes the connection before Content-Length is reached, so that the client notices.
struct FileSlice {
    std::shared_ptr<const Descriptor> file;
    std::uint64_t offset = 0, size = 0;
    // If the file has no name, the size of the whole file, because a nameless file takes memory
    // while it is open; else 0.
    std::uint64_t memory_bytes = 0;
};

// A part of a body. A body is sent piece by piece.
using Piece = std::variant<Text, FileSlice>;
using Pieces = std::vector<Piece>;
[[nodiscard]] std::uint64_t size_of(const Piece& piece);
[[nodiscard]] std::uint64_t size_of(const Pieces& pieces);
// Returns the bytes [offset, offset + size), which must exist.
[[nodiscard]] Pieces part_of(const Pieces& pieces, std::uint64_t offset, std::uint64_t size);

// A body whose length is not known, as for server-sent events.
class Stream {
  public:
    virtual ~Stream() = default;
    // Returns up to `most` bytes. Returns an empty text if nothing is pending now, and none if the
    // stream is over.
    virtual std::optional<std::string> read(std::size_t most) = 0;
    // Sets a function that the stream calls, from any thread, when there is more to read or the
    // stream is over. The server sets null when the client is gone.
    virtual void on_more(std::function<void()> more) = 0;
};

struct Answer {
    unsigned status = 200;
    Fields headers;  // except Content-Length, Date and Connection, which the server writes
    std::variant<Pieces, std::shared_ptr<Stream>> body = Pieces{};
    bool closes = false;  // close the connection after this answer
    // Cause of a failure, for the log only. It may name paths of the server, which clients must not
    // see.
    std::string trouble = {};

    Answer& with(std::string name, std::string value) {
        headers.emplace_back(std::move(name), std::move(value));
        return *this;
    }
};

// Answers with a body of text. The content type may name a charset.
[[nodiscard]] Answer text_answer(unsigned status, std::string content_type, std::string body);
// Answers with a sentence in plain text, for people.
[[nodiscard]] Answer sentence(unsigned status, std::string_view text);
// Answers with {"error": "..."}, for programs. The second form takes an error of the library. Its
// code gives the status: not_found 404, bad_argument 400, busy, exhausted, over_budget and unmet
// 503 with Retry-After, others 500. The paths of the server are left out of the message.
[[nodiscard]] Answer json_error(unsigned status, std::string_view text);
[[nodiscard]] Answer json_error(const Error& error);
[[nodiscard]] unsigned status_of(const Error& error);
// Returns the message with "a file" in place of each path of the server.
[[nodiscard]] std::string without_paths(std::string_view message);
// Adds an error of the server. It is logged and not sent to the client.
[[nodiscard]] Answer with_trouble(Answer answer, const Error& error);
// Redirects to another path of this server.
[[nodiscard]] Answer moved_to(const Request& request, std::string_view path);
// Answers 503 with Retry-After.
[[nodiscard]] Answer come_back(std::chrono::seconds after, std::string_view text);

// All that an address has to offer. answer_with() makes the answer to a request from it.
struct Entity {
    Pieces bytes;
    std::string content_type;
    std::string etag;  // with its quotes; empty: none
    std::optional<UtcTime> modified;
    std::string coding;  // Content-Encoding; empty: none
    // A client may reuse the content for this time; none: it must revalidate each use ("no-cache").
    std::optional<std::chrono::seconds> max_age;
    bool never_changes = false;  // adds "immutable"
    bool varies = false;         // differs by Accept-Encoding
    Fields headers;              // further headers
};

// Answers GET and HEAD. Handles If-None-Match and If-Modified-Since (304), If-Match and
// If-Unmodified-Since (412), Range with one part, a suffix or up to 16 parts (206; several parts as
// multipart/byteranges), If-Range, and 416. A Range that makes no sense is ignored, as RFC 9110
// section 14.2 says.
[[nodiscard]] Answer answer_with(const Request& request, Entity entity);

// http_date() returns a date such as "Thu, 17 Mar 2022 00:08:42 GMT" (RFC 9110 section 5.6.7). The
// function after it reads any of the three forms that clients send.
[[nodiscard]] std::string http_date(UtcTime time);
[[nodiscard]] std::optional<UtcTime> parse_http_date(std::string_view text);

// Returns the text with `<`, `>`, `&`, `"` and `'` as entities. Control characters, which XML 1.0
// forbids, become U+FFFD.
[[nodiscard]] std::string xml_escaped(std::string_view text);

}  // namespace stormcellar::web
