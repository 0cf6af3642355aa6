// web/service/web_service.h -- the whole data server, made from a configuration: sources, doors and
// the HTTP server.
//
// Threads   One thread at a time. The server's own threads make the answers.
// Errors    See each function.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "web/config/web_setup.h"
#include "web/http/server.h"
#include "web/service/sources.h"

namespace stormcellar::web {

class WebService {
  public:
    // Opens the server. A machine without IPv6 does not listen on [::1]. Errors: those of
    // open_sources() and Server::open().
    static Result<std::unique_ptr<WebService>> open(WebSetup setup);

    // Returns a URL such as "http://127.0.0.1:8090/" for each address.
    [[nodiscard]] std::vector<std::string> addresses() const;
    [[nodiscard]] const WebSetup& setup() const { return sources_.setup; }
    // Returns false as long as there is no catalog. look_again() opens the catalog once it exists.
    [[nodiscard]] bool has_catalog() const { return sources_.catalog != nullptr; }
    // Returns false if the server could not be opened again after a reload. look_again() tries
    // again to open the server.
    [[nodiscard]] bool is_listening() const { return server_ != nullptr; }
    // Returns false if the server is not open. Otherwise waits for an answer of the server and
    // returns true. If the server is stuck, this deliberately never returns, so that the watchdog
    // restarts the service.
    [[nodiscard]] bool is_at_work() const;
    // Call it once a second.
    void look_again();

    // Applies a configuration, except the parts that needs_restart() names. A new server begins on
    // the same sockets, which stay open; then the old server ends, with its connections. If the new
    // server cannot begin, the old server goes on unchanged. If the old server's port is in the
    // way, the old server ends first, and begins again if the new server fails. Errors: those of
    // open().
    Status reload(WebSetup fresh);
    [[nodiscard]] ServerFacts facts() const;

  private:
    explicit WebService(Sources sources) : sources_(std::move(sources)) {}
    Status serve();
    void look_for_catalog();
    void listen_again();
    void note_numbers();

    Sources sources_;
    ListenSockets sockets_;
    std::string problem_;             // last logged problem with keeping the TimeNumbers
    std::unique_ptr<Server> server_;  // null only if it could not be opened again
};

// Returns the options of the server for a configuration. It is public for tests.
[[nodiscard]] ServerOptions server_options_of(const WebConfig& config);

}  // namespace stormcellar::web
