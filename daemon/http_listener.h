// daemon/http_listener.h -- one address on which pages are asked for, by libmicrohttpd.
//
// Inside the daemon room, for status_server.h. Nothing happens but in turn(), which never waits:
// the caller polls descriptor() for next_time() at most.
// Thread contract: one thread.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "daemon/listening_socket.h"
#include "daemon/schedule.h"

struct MHD_Daemon;
struct MHD_Connection;
struct MHD_Response;

namespace stormcellar::daemon {

class HttpListener {
  public:
    // The answer to GET or HEAD of a path, and its HTTP status.
    struct Answer {
        MHD_Response* response = nullptr;  // stays the giver's; null ends the connection
        unsigned status = 0;
    };
    using Answerer = std::function<Answer(const char* method, const char* url)>;
    struct Limits {
        std::chrono::milliseconds longest_connection{0};
        unsigned most_connections = 0;
    };

    // io when libmicrohttpd cannot begin. The answerer must not throw.
    static Result<std::unique_ptr<HttpListener>> open(ListeningSocket socket, Limits limits,
                                                      Answerer answerer);
    HttpListener(const HttpListener&) = delete;
    HttpListener& operator=(const HttpListener&) = delete;
    ~HttpListener();

    [[nodiscard]] bool still_stands() const { return socket_.still_stands(); }
    [[nodiscard]] int descriptor() const { return epoll_; }
    // When turn() is due though nothing has come; none: never.
    [[nodiscard]] std::optional<SteadyTime> next_time(SteadyTime now) const;
    // Takes, reads, answers and ends connections, as far as that needs no waiting. Where three
    // quarters of the most stand, the one that has stood for longest goes for each new one.
    void turn(SteadyTime now);

  private:
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
    MHD_Daemon* daemon_ = nullptr;
    int epoll_ = -1;
};

}  // namespace stormcellar::daemon
