// daemon/status/http_listener.h -- serves pages at one address, with libmicrohttpd.
//
// Only status_server.cpp uses this class. All work is done in turn(), which never waits. The caller
// polls descriptor(), until next_time() at most.
//
// Threads   One thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string_view>

#include "base/steady_time.h"
#include "daemon/status/listening_socket.h"

struct MHD_Daemon;
struct MHD_Connection;
struct MHD_Response;

namespace stormcellar::daemon {

class HttpListener {
  public:
    struct Request {
        const char* method;
        const char* url;
        // True if the request came to a port and one of its Host fields is not a name of a loopback
        // address (base/host_field.h). This check protects against web pages. A request without the
        // field passes: HTTP/1.0 allows that, and a web page cannot make a browser leave the field
        // out.
        bool names_another_host;
    };
    // The answer to a request, with its HTTP status.
    struct Answer {
        MHD_Response* response = nullptr;  // owned by the answerer; null: the connection ends
        unsigned status = 0;
    };
    using Answerer = std::function<Answer(const Request&)>;
    struct Limits {
        std::chrono::milliseconds longest_connection{0};
        unsigned most_connections = 0;
    };

    // Starts to serve. The answerer must not throw. Errors: io if libmicrohttpd cannot start.
    static Result<std::unique_ptr<HttpListener>> open(ListeningSocket socket, Limits limits,
                                                      Answerer answerer);
    HttpListener(const HttpListener&) = delete;
    HttpListener& operator=(const HttpListener&) = delete;
    ~HttpListener();

    [[nodiscard]] bool still_stands() const { return socket_.still_stands(); }
    [[nodiscard]] int descriptor() const { return epoll_; }
    // Returns when turn() is due even if nothing arrives; none if it is never due.
    [[nodiscard]] std::optional<SteadyTime> next_time(SteadyTime now) const;
    // Accepts, reads, answers and closes connections as far as possible without waiting. If three
    // quarters of the allowed connections are open, each new connection closes the oldest one.
    void turn(SteadyTime now);

  private:
    // Number of rounds in one turn, so that a flood of requests does not make turn() endless.
    static constexpr int most_rounds = 64;
    struct Callbacks;
    struct Open {
        int descriptor;
        SteadyTime ends;
        bool is_cut;
    };
    HttpListener(ListeningSocket socket, Limits limits, Answerer answerer);
    void make_room();

    ListeningSocket socket_;
    Limits limits_;
    Answerer answerer_;
    std::map<MHD_Connection*, Open> open_;
    std::uint64_t changes_ = 0;  // number of times that a connection was opened or closed
    bool is_behind_ = false;     // the last turn ended with work left
    MHD_Daemon* daemon_ = nullptr;
    int epoll_ = -1;
};

}  // namespace stormcellar::daemon
