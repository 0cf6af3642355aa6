// web/http/answer.h -- what the server sends.
//
// Threads   Plain values. What they share is constant, but for a Stream, which locks itself.
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

// A part of a file. It is read as it is sent: if the file is cut meanwhile, the connection is
// closed before Content-Length is reached, so that the client can tell.
struct FileSlice {
    std::shared_ptr<const Descriptor> file;
    std::uint64_t offset = 0, size = 0;
    // The size of the whole file if it has no name and so takes room only as long as it is open;
    // else 0.
    std::uint64_t memory_bytes = 0;
};

// The bytes of a body, one piece after another.
using Piece = std::variant<Text, FileSlice>;
using Pieces = std::vector<Piece>;
[[nodiscard]] std::uint64_t size_of(const Piece& piece);
[[nodiscard]] std::uint64_t size_of(const Pieces& pieces);
// Returns the bytes [offset, offset + size) of all, which must be there.
[[nodiscard]] Pieces part_of(const Pieces& pieces, std::uint64_t offset, std::uint64_t size);

// A body whose end is not known: server-sent events.
class Stream {
  public:
    virtual ~Stream() = default;
    // Returns up to `most` bytes; empty: there is nothing yet; none: the stream is over.
    virtual std::optional<std::string> read(std::size_t most) = 0;
    // The server gives a function that the stream calls, from any thread, when there is more to
    // read or the stream is over. It is called with null when the client is gone.
    virtual void on_more(std::function<void()> more) = 0;
};

struct Answer {
    unsigned status = 200;
    Fields headers;  // without Content-Length, Date and Connection, which the server writes
    std::variant<Pieces, std::shared_ptr<Stream>> body = Pieces{};
    bool closes = false;  // the connection ends with this answer
    // Cause of a failure, for the log. The client must not see it, because it may name paths of the
    // server.
    std::string trouble = {};

    Answer& with(std::string name, std::string value) {
        headers.emplace_back(std::move(name), std::move(value));
        return *this;
    }
};

// An answer with a body of text. The content type may name a charset.
[[nodiscard]] Answer text_answer(unsigned status, std::string content_type, std::string body);
// A sentence in plain text, for people.
[[nodiscard]] Answer sentence(unsigned status, std::string_view text);
// {"error": "..."}, for programs; and an error of a room, with the status that fits its code:
// not_found 404, bad_argument 400, busy, exhausted, over_budget and unmet 503 with Retry-After,
// others 500. Paths of the server in its message are left out.
[[nodiscard]] Answer json_error(unsigned status, std::string_view text);
[[nodiscard]] Answer json_error(const Error& error);
[[nodiscard]] unsigned status_of(const Error& error);
// Returns the message with "a file" for each path of the server.
[[nodiscard]] std::string without_paths(std::string_view message);
// Adds an error of the server for the log, which the client is not told.
[[nodiscard]] Answer with_trouble(Answer answer, const Error& error);
// A redirection to another path of this server.
[[nodiscard]] Answer moved_to(const Request& request, std::string_view path);
// 503 with Retry-After.
[[nodiscard]] Answer come_back(std::chrono::seconds after, std::string_view text);

// All that an address holds. answer_with() makes of it the answer that the client asked for.
struct Entity {
    Pieces bytes;
    std::string content_type;
    std::string etag;  // with its quotes; empty: none
    std::optional<UtcTime> modified;
    std::string coding;  // Content-Encoding; empty: none
    // Time for which a client may use it without asking; none: it must always ask ("no-cache").
    std::optional<std::chrono::seconds> max_age;
    bool never_changes = false;  // adds "immutable"
    bool varies = false;         // by Accept-Encoding
    Fields headers;              // more of them
};

// Answers GET and HEAD: If-None-Match and If-Modified-Since (304), If-Match and If-Unmodified-Since
// (412), Range with one part, a suffix or up to 16 parts (206; several as multipart/byteranges),
// If-Range, 416. A Range that makes no sense is ignored, as RFC 9110 section 14.2 says.
[[nodiscard]] Answer answer_with(const Request& request, Entity entity);

// "Thu, 17 Mar 2022 00:08:42 GMT" (RFC 9110 section 5.6.7), and what a client sends in any of its
// three forms.
[[nodiscard]] std::string http_date(UtcTime time);
[[nodiscard]] std::optional<UtcTime> parse_http_date(std::string_view text);

// `<`, `>`, `&`, `"` and `'` as entities; control characters, which XML 1.0 does not allow, as
// U+FFFD.
[[nodiscard]] std::string xml_escaped(std::string_view text);

}  // namespace stormcellar::web
