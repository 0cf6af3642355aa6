// daemon/status/status_server.h -- answers who asks for the status: HTTP on a Unix socket and,
// where it is switched on, on a port of the loopback addresses.
//
//   GET /metrics       Prometheus text (metrics_text.h)
//   GET /status.json   status_json.h
// Everything else is 404, 405 or 400; each answer ends its connection. On a port, a request whose
// Host is no name of the loopback addresses is 421 (loopback_host.h); on the socket any Host will
// do. No answer is to be cached, or taken for another type than it says. HTTP itself is
// libmicrohttpd's business, which answers what is no HTTP (400, 413, 414, 431) with fixed text of
// its own, without these fields.
// One thread of its own, at a lower priority. Clients can be as hostile as they like: connections
// are few and end after 10 seconds whatever they do, sooner where more come, a request has at most
// a few KiB, and a page is made at most five times a second. What cannot be opened is logged once
// and tried again; so is a socket whose path somebody has removed. A path that is too long for a
// socket is said and left. Thread contract: any one thread makes and destroys it; `render` is
// called from its own thread.
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
    std::chrono::milliseconds freshness{200};  // of a page
    unsigned most_connections = 32;            // of each address
};

enum class StatusPage { metrics, json };

class StatusServer {
  public:
    // Gives a page, or nothing while there is none yet (503).
    using Render = std::function<std::string(StatusPage)>;

    StatusServer(StatusServerOptions options, Render render);
    StatusServer(const StatusServer&) = delete;
    StatusServer& operator=(const StatusServer&) = delete;
    ~StatusServer();

    // Whether every address is listened at, but for those that can never be; what is wrong with the
    // first that is not. From any thread.
    [[nodiscard]] Status answers() const;
    [[nodiscard]] const Pulse& pulse() const { return pulse_; }  // of its thread

  private:
    class Worker;
    void run();

    std::unique_ptr<Worker> worker_;  // of the thread
    WakeUp wake_up_;
    std::atomic<bool> stopping_ = false;
    mutable std::mutex unanswered_mutex_;
    std::string unanswered_ = "the status is not served yet";  // guarded by it; empty: all are
    Pulse pulse_;
    std::thread thread_;  // the last member: it uses what stands above
};

// What a board holds, as pages.
[[nodiscard]] StatusServer::Render pages_of(const StatusBoard& board);

}  // namespace stormcellar::daemon
