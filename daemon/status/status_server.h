// daemon/status/status_server.h -- serves the status: HTTP on a Unix socket and, if it is enabled,
// on a port of the loopback addresses.
//
//   GET /metrics       Prometheus text (metrics_text.h)
//   GET /status.json   status_json.h
// All other requests get 404, 405 or 400; each answer ends its connection. On a port, a request
// whose Host is not a name of the loopback addresses gets 421 (loopback_host.h); on the socket any
// Host is accepted. Answers forbid caching and guessing of their type. libmicrohttpd handles HTTP
// itself: it answers what is not HTTP (400, 413, 414, 431) with its own fixed text, without these
// fields. The server has one thread, at a lower priority. Clients may be hostile: connections are
// few and end after 10 seconds in any case, or sooner if more come; a request has at most a few
// KiB; a page is rendered at most five times a second. An address that cannot be opened is logged
// once and tried again; so is a socket whose path somebody removed. A path that is too long for a
// socket is logged, and not tried again. Thread contract: one thread, which may be any, creates and
// destroys the server; `render` is called from the server's own thread.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/process/pulse.h"
#include "daemon/process/wake_up.h"
#include "daemon/status/status_board.h"

namespace stormcellar::daemon {

struct StatusServerOptions {
    std::filesystem::path socket;  // empty: none
    int http_port = 0;             // 0: none
    std::chrono::milliseconds retry{15'000};
    std::chrono::milliseconds longest_connection{10'000};
    std::chrono::milliseconds freshness{200};  // how old a rendered page may be
    unsigned most_connections = 32;            // on each address
};

enum class StatusPage { metrics, json };

class StatusServer {
  public:
    // Returns a page, or nothing while there is none yet (503).
    using Render = std::function<std::string(StatusPage)>;

    StatusServer(StatusServerOptions options, Render render);
    StatusServer(const StatusServer&) = delete;
    StatusServer& operator=(const StatusServer&) = delete;
    ~StatusServer();

    // Fails if an address is not served, except one that can never be; the error is that of the
    // first such address. Any thread may call it.
    [[nodiscard]] Status answers() const;
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of its thread

  private:
    class Worker;
    void run();

    std::unique_ptr<Worker> worker_;  // used only by the thread
    WakeUp wake_up_;
    std::atomic<bool> stopping_ = false;
    mutable std::mutex unanswered_mutex_;
    std::string unanswered_ =
        "the status is not served yet";  // guarded by the mutex; empty: all are
    Pulse pulse_;
    std::thread thread_;  // the last member: the thread uses the members above
};

// The pages of what a board holds.
[[nodiscard]] StatusServer::Render pages_of(const StatusBoard& board);

}  // namespace stormcellar::daemon
