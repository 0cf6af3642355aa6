// web/http/server.h -- answers HTTP/1.1 by libmicrohttpd, through doors (web/http/door.h).
//
// One thread for each address that is listened on serves all of its connections. Answers that take
// time are made by a bounded number of workers. GET, HEAD and OPTIONS are answered, and nothing
// else; the Host field is checked before anything else, since a page of the web could otherwise
// read what is served on loopback (DNS rebinding).
//
// Threads   Many threads may use it. Doors are called from many threads.
// Errors    busy: an address is in use; bad_argument: it is no address; io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "web/http/door.h"
#include "web/http/listen_sockets.h"
#include "web/http/server_options.h"

namespace stormcellar::web {

// Connections, requests and memory that the server holds at the moment.
struct ServerFacts {
    std::size_t connections = 0, streams = 0, waiting = 0, working = 0;
    std::uint64_t answer_bytes = 0;  // of answers on their way, in memory
};

class Server {
  public:
    // Listens on `sockets`, which stay open when the server ends; without any, on those that it
    // opens for the addresses of the options.
    static Result<std::unique_ptr<Server>> open(ServerOptions options,
                                                std::shared_ptr<const Doors> doors,
                                                ListenSockets sockets = {});
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    // Stops: streams end, requests that wait for a worker get 503, answers under way are finished
    // as far as that takes no longer than two seconds.
    ~Server();

    // "http://127.0.0.1:8090/", one for each address, with the port that it has.
    [[nodiscard]] std::vector<std::string> addresses() const;
    [[nodiscard]] ServerFacts facts() const;

  private:
    struct Impl;
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::web
