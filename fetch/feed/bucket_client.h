// fetch/feed/bucket_client.h -- fetches listings and chunks from the bucket, many at a time, on one
// thread.
//
// The client talks only to the configured address: it follows no redirects and ignores proxies of
// the environment. It limits the bytes, the time and the pages of each answer.
//
// Threads   One thread at a time. run() calls the functions that take answers.
// Errors    The function that takes the answer gets the error. The message gives the cause.
//           busy        may pass: no connection, a timeout, 429, 500 and above, or a cut transfer
//           not_found   404 and 410
//           permission  403
//           over_budget more bytes or pages than are plausible
//           truncated   fewer bytes than the listing says
//           corrupt     the answer is not a listing
//           io          any other answer
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fetch/bucket/bucket_listing.h"
#include "fetch/feed/feed_config.h"
#include "stormcellar/base/result.h"

namespace stormcellar::fetch {
class Transfers;
}

namespace stormcellar::feed {

using Bytes = std::vector<std::byte>;

class BucketClient {
  public:
    [[nodiscard]] static Result<std::unique_ptr<BucketClient>> open(const FeedConfig& config);
    BucketClient(const BucketClient&) = delete;
    BucketClient& operator=(const BucketClient&) = delete;
    ~BucketClient();

    // Asks for a listing after `wait`, and passes the result to `taken`. Joins all pages of a long
    // listing. But if the question asks for fewer than 1,000 keys, takes only the first page.
    void list(fetch::ListingQuestion question, std::chrono::milliseconds wait,
              std::function<void(Result<fetch::ListingPage>)> taken);
    // Asks for an object that must have `size` bytes, and passes its bytes to `taken`.
    void get(const std::string& key, std::uint64_t size, std::function<void(Result<Bytes>)> taken);
    // Runs until the flag is set or nothing is left to ask. Calls `turn` at least ten times a
    // second.
    void run(const std::atomic<bool>& stop, const std::function<void()>& turn);

    // Returns the wait that the server requested in its last answer; 0 if it requested none. Call
    // it from the functions that take answers.
    [[nodiscard]] std::chrono::seconds retry_after() const { return retry_after_; }

  private:
    struct Pages;
    explicit BucketClient(std::string bucket);
    void ask_page(std::shared_ptr<Pages> pages, std::chrono::milliseconds wait);
    void take_page(const std::shared_ptr<Pages>& pages, Result<Bytes> body);
    void ask(std::string url, std::uint64_t most, std::chrono::milliseconds wait,
             std::function<void(Result<Bytes>)> taken);

    std::string bucket_;
    std::unique_ptr<fetch::Transfers> transfers_;
    std::chrono::seconds retry_after_{0};
};

}  // namespace stormcellar::feed
