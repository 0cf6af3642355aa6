// web/service/web_service.h -- the data server as a whole: sources, doors and the HTTP server, made
// from a configuration.
//
// Threads   One thread at a time; the server's own threads answer.
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
    // Errors: those of open_sources() and Server::open(). A machine without IPv6 listens without
    // [::1].
    static Result<std::unique_ptr<WebService>> open(WebSetup setup);

    // Returns a URL such as "http://127.0.0.1:8090/" for each address.
    [[nodiscard]] std::vector<std::string> addresses() const;
    [[nodiscard]] const WebSetup& setup() const { return sources_.setup; }
    // Returns false while there is no catalog; look_again() opens it once it exists.
    [[nodiscard]] bool has_catalog() const { return sources_.catalog != nullptr; }
    // Returns false if the server could not be opened again after a reload. look_again() tries
    // again.
    [[nodiscard]] bool is_listening() const { return server_ != nullptr; }
    // Returns false if the server is not open. Otherwise waits for an answer of the server and
    // returns true. If the server is stuck, this deliberately never returns, so that the watchdog
    // restarts the service.
    [[nodiscard]] bool is_at_work() const;
    // Call once a second.
    void look_again();

    // Applies a configuration, except the parts that needs_restart() names. A new server begins on
    // the same sockets, which stay open; then the old server ends with its connections. If the new
    // server cannot begin, the old one goes on unchanged, or begins again if its port was in the
    // way. Errors: those of open().
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

// Returns the server's options for a configuration. Public for tests.
[[nodiscard]] ServerOptions server_options_of(const WebConfig& config);

}  // namespace stormcellar::web
