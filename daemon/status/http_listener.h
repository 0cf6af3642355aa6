// daemon/status/http_listener.h -- one address that serves pages, by libmicrohttpd.
//
// Inside the daemon room, for status_server.h. All work happens in turn(), which never waits: the
// caller polls descriptor(), no longer than until next_time(). Thread contract: one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>

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
        // On a port: the Host field does not satisfy is_loopback_host(). A request without the
        // field is allowed, as in HTTP/1.0; browsers, whose pages this guards against, always send
        // one.
        bool names_another_host;
    };
    // The answer to a request, and its HTTP status.
    struct Answer {
        MHD_Response* response = nullptr;  // the giver still owns it; null ends the connection
        unsigned status = 0;
    };
    using Answerer = std::function<Answer(const Request&)>;
    struct Limits {
        std::chrono::milliseconds longest_connection{0};
        unsigned most_connections = 0;
    };

    // Errors: io if libmicrohttpd cannot start. The answerer must not throw.
    static Result<std::unique_ptr<HttpListener>> open(ListeningSocket socket, Limits limits,
                                                      Answerer answerer);
    HttpListener(const HttpListener&) = delete;
    HttpListener& operator=(const HttpListener&) = delete;
    ~HttpListener();

    [[nodiscard]] bool still_stands() const { return socket_.still_stands(); }
    [[nodiscard]] int descriptor() const { return epoll_; }
    // When turn() is due even if nothing comes; none: never.
    [[nodiscard]] std::optional<SteadyTime> next_time(SteadyTime now) const;
    // Accepts, reads, answers and ends connections, as far as possible without waiting. Once three
    // quarters of the connections are in use, each new one ends the oldest.
    void turn(SteadyTime now);

  private:
    static constexpr int most_rounds =
        64;  // in one turn, so that a flood does not make a turn endless
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
    std::uint64_t changes_ = 0;  // connections that were opened or closed
    bool is_behind_ = false;     // the last turn ended before it had handled all that had come
    MHD_Daemon* daemon_ = nullptr;
    int epoll_ = -1;
};

}  // namespace stormcellar::daemon
