// web/http/server.h -- answers HTTP/1.1 with libmicrohttpd, through doors (web/http/door.h).
//
// One thread for each address on which the server listens serves all connections of that address. A
// limited number of workers makes the answers that take time. The server answers only GET, HEAD and
// OPTIONS. It checks the Host field first, because otherwise a web page could read data that are
// served on loopback (DNS rebinding).
//
// Threads   Many threads may use it. Doors are called from many threads.
// Errors    busy if an address is in use; bad_argument for a text that is not an address; io.
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

// The connections, requests and memory that the server holds now.
struct ServerFacts {
    std::size_t connections = 0, streams = 0, waiting = 0, working = 0;
    std::uint64_t answer_bytes = 0;  // of answers on their way, in memory
};

class Server {
  public:
    // Listens on `sockets`, which stay open when the server ends. If `sockets` is empty, opens
    // sockets for the addresses in the options.
    static Result<std::unique_ptr<Server>> open(ServerOptions options,
                                                std::shared_ptr<const Doors> doors,
                                                ListenSockets sockets = {});
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;
    // Stops. Streams end. Requests that wait for a worker get 503. Answers under way are finished
    // if that takes at most two seconds.
    ~Server();

    // Returns a URL with the actual port, such as "http://127.0.0.1:8090/", for each address.
    [[nodiscard]] std::vector<std::string> addresses() const;
    [[nodiscard]] ServerFacts facts() const;

  private:
    struct Impl;
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::web
