// fetch/pull/http_client.h -- makes one GET or POST at a time, over a connection that stays open.
//
// The client follows no redirects and speaks only http and https. It limits the bytes and the time
// of each answer. If `stop` is set, a transfer ends within a second or so.
//
// Threads   One thread at a time. Any thread may set `stop`.
// Errors    busy         may pass: no connection, a timeout, 408, 429, 500 and above, or
//                        `stop`
//           truncated    the body ended early
//           over_budget  more bytes than allowed
//           not_found    404 and 410
//           io           any other answer
//           Errors of `take` are passed on with their own code.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "stormcellar/base/result.h"

namespace stormcellar::pull {

struct HttpRequest {
    std::string url;
    // The tag of the content that the caller already has, with its quotes. The server need not send
    // this content again.
    std::string known_tag;
    std::uint64_t most_bytes = 0;  // of the body
    // Takes the body of an answer 200, piece by piece. If `take` returns an error, the transfer
    // ends.
    std::function<Status(std::span<const std::byte>)> take;
};

struct HttpAnswer {
    bool is_unchanged = false;  // 304
    std::string tag;            // from the header ETag, with its quotes; may be empty
    std::uint64_t bytes = 0;    // of the body
};

struct HttpOptions {
    std::chrono::seconds connect{10};
    std::chrono::seconds stall{20};     // a transfer fails if no byte comes for this long
    std::chrono::seconds longest{300};  // limit of a whole transfer
    const std::atomic<bool>* stop = nullptr;
    std::function<void()> beat;              // called at least once a second during a transfer
    std::string agent = "stormcellar-pull";  // the name of the program in requests
};

class HttpClient {
  public:
    explicit HttpClient(HttpOptions options);
    HttpClient(const HttpClient&) = delete;
    HttpClient& operator=(const HttpClient&) = delete;
    ~HttpClient();

    [[nodiscard]] Result<HttpAnswer> get(const HttpRequest& request);
    // Sends JSON by POST. Succeeds if the server answers 200 to 299; ignores the body of the
    // answer.
    [[nodiscard]] Status post(const std::string& url, const std::string& json);
    // Returns the wait that the last answer requested (Retry-After), or none.
    [[nodiscard]] std::optional<std::chrono::seconds> retry_after() const { return retry_after_; }

  private:
    struct Handle;
    Status transfer(const HttpRequest& request, const std::string& header);
    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& url);
    HttpOptions options_;
    std::unique_ptr<Handle> handle_;
    std::optional<std::chrono::seconds> retry_after_;
};

}  // namespace stormcellar::pull
