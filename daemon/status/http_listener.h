// daemon/status/http_listener.h -- one address on which pages are asked for, by libmicrohttpd.
//
// Inside the daemon room, for status_server.h. Nothing happens but in turn(), which never waits:
// the caller polls descriptor() for next_time() at most.
// Thread contract: one thread.
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

// Whether `host`, the value of a Host field, is 127.0.0.1, localhost (in any case) or [::1], with
// nothing behind it or ":" and a port. Any port: at the other end of a tunnel it is another one,
// and no page can give the names of loopback addresses to itself.
//
// A page of the web may give its own name the address 127.0.0.1 (DNS rebinding). A browser then
// takes what is answered there for that page's own data and hands it over. It sends the page's name
// as Host, so whoever answers only names of the loopback addresses tells such a page nothing.
[[nodiscard]] bool is_loopback_host(std::string_view host) noexcept;

class HttpListener {
  public:
    struct Request {
        const char* method;
        const char* url;
        // On a port: a Host field is none of is_loopback_host(). A request without the field names
        // nobody: HTTP/1.0 allows that, and browsers, against whose pages this is, always send one.
        bool names_another_host;
    };
    // The answer to a request, and its HTTP status.
    struct Answer {
        MHD_Response* response = nullptr;  // stays the giver's; null ends the connection
        unsigned status = 0;
    };
    using Answerer = std::function<Answer(const Request&)>;
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
    static constexpr int most_rounds = 64;  // of one turn, so that a flood does not make it endless
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
    std::uint64_t changes_ = 0;  // connections that came or went
    bool is_behind_ = false;     // a turn has ended before all that had come was taken
    MHD_Daemon* daemon_ = nullptr;
    int epoll_ = -1;
};

}  // namespace stormcellar::daemon
