// tests/fetch/mock_bucket.h -- a bucket on loopback that answers like Amazon S3, with the faults
// that a test sets.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/fetch/scripted_server.h"

namespace stormcellar::fetch {

class MockBucket {
  public:
    enum class Fault {
        none,
        unavailable,  // 503
        cut,          // the connection ends in the middle of the body
        longer,       // more bytes than the listing says
        shorter,      // a whole answer of fewer bytes than the listing says
        stalled,      // half of the body, and then nothing more
        missing,      // 404
        no_xml,       // for a listing: something other than XML
        changed,      // 412: the object has changed
        other_part,   // 206, from another byte than requested
        endless_error,
    };

    MockBucket() = default;
    MockBucket(const MockBucket&) = delete;
    MockBucket& operator=(const MockBucket&) = delete;

    [[nodiscard]] std::string address() const { return server_.url(); }
    void put(const std::string& key, std::string contents);
    // Sets the faults of the next answers for this key (or for listings of this prefix).
    void fail_next(const std::string& key, std::vector<Fault> faults);
    void set_page(std::size_t keys) { page_ = keys; }
    // asked() returns how often `key` was requested. last_from() returns the first byte that the
    // last request for the key asked for.
    [[nodiscard]] std::size_t asked(const std::string& key) const;
    [[nodiscard]] std::size_t last_from(const std::string& key) const;
    [[nodiscard]] std::size_t most_at_once() const { return server_.most_at_once(); }

  private:
    testing::Reply answer(const testing::Asked& asked);
    [[nodiscard]] testing::Reply object(const testing::Asked& asked, Fault fault);
    [[nodiscard]] std::string listing(const std::string& prefix, const std::string& token);
    Fault next_fault(const std::string& key);

    std::size_t page_ = 1000;
    mutable std::mutex mutex_;
    std::map<std::string, std::string> objects_;
    std::map<std::string, std::deque<Fault>> faults_;
    std::map<std::string, std::size_t> asked_, last_from_;
    testing::ScriptedServer server_{[this](const testing::Asked& asked) { return answer(asked); }};
};

}  // namespace stormcellar::fetch
