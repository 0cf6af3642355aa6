// tests/fetch/mock_bucket.h -- a bucket on loopback that answers as Amazon S3 does, and misbehaves
// where it is told to.
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace stormcellar::fetch {

class MockBucket {
  public:
    enum class Fault {
        none,
        unavailable,  // 503
        cut,          // the connection ends in the midst of the body
        longer,       // more bytes than the listing says
        shorter,      // a whole answer of fewer bytes than the listing says
        stalled,      // half of the body, and then nothing
        missing,      // 404
        no_xml,       // of a listing: something else
        changed,      // 412: other contents than those that are asked for
        other_part,   // 206, from another byte than was asked for
        endless_error,
    };

    MockBucket();
    ~MockBucket();
    MockBucket(const MockBucket&) = delete;
    MockBucket& operator=(const MockBucket&) = delete;

    [[nodiscard]] std::string address() const;
    void put(const std::string& key, std::string contents);
    // What goes wrong with the next answers for this key (or for listings of this prefix).
    void fail_next(const std::string& key, std::vector<Fault> faults);
    void set_page(std::size_t keys) { page_ = keys; }
    // How often each key was asked for, and from which byte on the last time.
    [[nodiscard]] std::size_t asked(const std::string& key) const;
    [[nodiscard]] std::size_t last_from(const std::string& key) const;
    [[nodiscard]] std::size_t most_at_once() const { return most_at_once_; }

  private:
    void serve();
    void answer(int connection);
    [[nodiscard]] std::string listing(const std::string& prefix, const std::string& token);
    Fault next_fault(const std::string& key);

    int listener_ = -1;
    int port_ = 0;
    std::atomic<bool> stop_{false};
    std::atomic<std::size_t> at_once_{0}, most_at_once_{0};
    std::size_t page_ = 1000;
    mutable std::mutex mutex_;
    std::map<std::string, std::string> objects_;
    std::map<std::string, std::deque<Fault>> faults_;
    std::map<std::string, std::size_t> asked_, last_from_;
    std::vector<std::thread> answering_;
    std::thread thread_;
};

}  // namespace stormcellar::fetch
