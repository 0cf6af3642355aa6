// daemon/status/http_listener.h -- serves pages at one address, with libmicrohttpd.
//
// Only status_server.cpp uses this class. All work happens in turn(), which never waits: the caller
// polls descriptor() until next_time() at most.
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
        // True if the request came to a port and a Host field is not a name of a loopback address
        // (base/host_field.h). A request without the field is accepted: HTTP/1.0 allows that, and
        // web pages, against which this check protects, cannot make a browser leave it out.
        bool names_another_host;
    };
    // The answer to a request, and its HTTP status.
    struct Answer {
        MHD_Response* response = nullptr;  // owned by the answerer; null ends the connection
        unsigned status = 0;
    };
    using Answerer = std::function<Answer(const Request&)>;
    struct Limits {
        std::chrono::milliseconds longest_connection{0};
        unsigned most_connections = 0;
    };

    // The answerer must not throw. Errors: io if libmicrohttpd cannot start.
    static Result<std::unique_ptr<HttpListener>> open(ListeningSocket socket, Limits limits,
                                                      Answerer answerer);
    HttpListener(const HttpListener&) = delete;
    HttpListener& operator=(const HttpListener&) = delete;
    ~HttpListener();

    [[nodiscard]] bool still_stands() const { return socket_.still_stands(); }
    [[nodiscard]] int descriptor() const { return epoll_; }
    // Returns when turn() is due even if nothing arrives; none: never.
    [[nodiscard]] std::optional<SteadyTime> next_time(SteadyTime now) const;
    // Accepts, reads, answers and closes connections as far as possible without waiting. If three
    // quarters of the allowed connections are open, each new connection closes the oldest one.
    void turn(SteadyTime now);

  private:
    // rounds in one turn, so that a flood does not make turn() endless
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
    std::uint64_t changes_ = 0;  // how many connections were opened or closed
    bool is_behind_ = false;     // the last turn ended with work left
    MHD_Daemon* daemon_ = nullptr;
    int epoll_ = -1;
};

}  // namespace stormcellar::daemon
