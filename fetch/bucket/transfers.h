// fetch/bucket/transfers.h -- makes HTTP GETs with libcurl, several at a time.
//
// The module stormcellar_fetch and the program stormcellar-feed use this class; both link libcurl.
//
// Threads   One thread at a time.
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

// An object to get.
struct Transfer {
    std::string url;
    std::uint64_t from_byte = 0;  // 0: the whole object
    // The tag (ETag) of the object. It is sent if only a part is requested. The server answers 412
    // if the object has changed.
    std::string tag;
    // Takes the next bytes of the body. If `take` returns false, the transfer fails and is not
    // tried again.
    std::function<bool(const std::byte* bytes, std::size_t count)> take;
    // Called before the body of an answer. `from_byte` is where the body begins; it is 0 if the
    // server sends the whole object although a part was requested. If `begin` returns false, the
    // transfer fails and is not tried again.
    std::function<bool(std::uint64_t from_byte)> begin;
    struct Outcome {
        bool good = false;
        bool may_be_tried_again = false;
        // The server cannot continue at from_byte, so only the whole object can be fetched.
        bool part_is_useless = false;
        bool is_refused = false;              // the server answered 403, 404 or 410
        std::string reason;                   // set if the transfer failed
        long status = 0;                      // HTTP status; 0: no answer
        std::chrono::seconds retry_after{0};  // the wait that the server asks for
        std::optional<UtcTime> modified;
    };
    // Called at the end of the transfer. May add further transfers, for example the same object
    // with another from_byte.
    std::function<void(const Outcome& outcome)> ended;
};

struct TransferOptions {
    int parallel = 8;
    std::chrono::seconds stall{30};   // a transfer fails if no byte comes for this long
    std::chrono::seconds longest{0};  // limit of a whole transfer; 0: no limit
    long most_redirects = 5;
    std::string proxy = {};             // a URL; empty: none, or the environment's proxy
    bool is_direct = false;             // ignore proxies of the environment
    std::string ca_file = {};           // certificates to trust; empty: the system's
    std::string agent = "stormcellar";  // the program's name for the server
};

class Transfers {
  public:
    [[nodiscard]] static Result<std::unique_ptr<Transfers>> make(TransferOptions options);
    Transfers(const Transfers&) = delete;
    Transfers& operator=(const Transfers&) = delete;
    ~Transfers();

    // Adds a transfer. It begins after `wait`, as soon as fewer than `parallel` transfers run.
    void add(Transfer transfer, std::chrono::milliseconds wait = {});
    // Runs until all transfers have ended or the flag is set. Calls `turn` at least ten times a
    // second.
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
