// fetch/transfers.h -- HTTP GETs, several at a time, with libcurl.
//
// Inside the module stormcellar_fetch alone. Thread contract: one thread.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <curl/curl.h>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::fetch {

// One thing to get.
struct Transfer {
    std::string url;
    std::uint64_t from_byte = 0;  // 0: all of it
    // Of the contents that are wanted, where not all of them are: what has others answers 412.
    std::string tag;
    // Takes the body; false: it cannot be taken, and the transfer fails for good.
    std::function<bool(const std::byte* bytes, std::size_t count)> take;
    // Called before the body of each answer. `from_byte`: where it begins, which is 0 where the
    // server gives all though a part was asked for.
    std::function<bool(std::uint64_t from_byte)> begin;
    struct Outcome {
        bool good = false;
        bool may_be_tried_again = false;
        bool part_is_useless = false;  // it cannot go on at from_byte: only all of it can be had
        std::string reason;            // where it is not good
        std::optional<UtcTime> modified;
    };
    // May add further transfers, this one with another from_byte among them.
    std::function<void(const Outcome& outcome)> ended;
};

struct TransferOptions {
    int parallel = 8;
    std::chrono::seconds stall{30};
};

class Transfers {
  public:
    [[nodiscard]] static Result<std::unique_ptr<Transfers>> make(TransferOptions options);
    Transfers(const Transfers&) = delete;
    Transfers& operator=(const Transfers&) = delete;
    ~Transfers();

    // Begins when there is room and `wait` has passed.
    void add(Transfer transfer, std::chrono::milliseconds wait = {});
    // Until all have ended, or the flag is set. `turn` is called often.
    void run(const std::atomic<bool>* stop, const std::function<void()>& turn);

  private:
    struct Running;
    using Clock = std::chrono::steady_clock;
    struct Waiting {
        Transfer transfer;
        Clock::time_point due;
    };

    explicit Transfers(TransferOptions options);
    void start_due();
    bool start(Transfer transfer);
    void finish_done();
    [[nodiscard]] int wait_ms() const;

    TransferOptions options_;
    CURLM* multi_ = nullptr;
    std::list<Waiting> waiting_;
    std::list<std::unique_ptr<Running>> running_;
};

}  // namespace stormcellar::fetch
