// daemon/status/status_server.h -- serves the status by HTTP: on a Unix socket and, if configured,
// on a port of the loopback addresses.
//
//   GET /metrics       Prometheus text (metrics_text.h)
//   GET /status.json   status_json.h
// All other requests give 404, 405 or 400. Each answer ends its connection. On a port, a request
// gives 421 if its Host is not a name of the loopback addresses (http_listener.h); on the socket
// every Host is accepted. Header fields of answers forbid caching, and guessing of the content
// type. libmicrohttpd answers invalid HTTP (400, 413, 414, 431) itself, with fixed texts and
// without these header fields.
//
// The server has one thread with a lower priority. Hostile clients do no harm: the number of
// connections is limited, a connection ends after 10 seconds at the latest (sooner if many more
// connections arrive), a request has at most a few KiB, and a page is rendered at most five times a
// second. An address that cannot be opened is logged once and tried again. A socket whose path was
// removed is opened again. A path that is too long for a socket is logged and not tried again.
//
// Threads   One thread makes and destroys the server. `render` is called from the server's own
//           thread.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "daemon/process/wake_up.h"
#include "daemon/status/status_board.h"
#include "service/pulse.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::daemon {

struct StatusServerOptions {
    std::filesystem::path socket;  // empty: none
    int http_port = 0;             // 0: none
    std::chrono::milliseconds retry{15'000};
    std::chrono::milliseconds longest_connection{10'000};
    // Time for which a page is served before it is rendered anew.
    std::chrono::milliseconds freshness{200};
    unsigned most_connections = 32;  // to each address
};

enum class StatusPage { metrics, json };

class StatusServer {
  public:
    // Returns a page. If it is empty, the server answers 503.
    using Render = std::function<std::string(StatusPage)>;

    StatusServer(StatusServerOptions options, Render render);
    StatusServer(const StatusServer&) = delete;
    StatusServer& operator=(const StatusServer&) = delete;
    ~StatusServer();

    // Returns ok if every address is served, else the first problem. Ignores [::1], which a machine
    // may lack, and paths that are too long for a socket. May be called from any thread.
    [[nodiscard]] Status answers() const;
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of the object's thread

  private:
    class Worker;
    void run();

    std::unique_ptr<Worker> worker_;  // used only by the thread
    WakeUp wake_up_;
    std::atomic<bool> stopping_ = false;
    mutable Mutex unanswered_mutex_;
    // The reason why an address is not served; empty: all addresses are served.
    std::string unanswered_ STORMCELLAR_GUARDED_BY(unanswered_mutex_) =
        "the status is not served yet";
    Pulse pulse_;
    std::thread thread_;  // the last member: it uses the members above
};

// Returns a function that renders pages of the status that was last posted on the board. The board
// must outlive the function.
[[nodiscard]] StatusServer::Render pages_of(const StatusBoard& board);

}  // namespace stormcellar::daemon
