// tests/daemon/status_client.h -- a client that can also violate HTTP, to test the status server.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::daemon {

class StatusClient {
  public:
    // Connects to the path. Waits at most a minute until a server listens.
    static StatusClient at_path(const std::filesystem::path& path);
    static StatusClient at_port(int port);

    [[nodiscard]] bool is_connected() const { return socket_.is_open(); }
    // Returns false if the server has closed the connection.
    bool send(const std::string& text) const;
    // Returns everything up to the end of the connection; none if it does not end within 20 s.
    [[nodiscard]] std::optional<std::string> read_to_end() const;
    // Returns true if the server has closed the connection, even if bytes are left to be read.
    [[nodiscard]] bool is_cut_off() const;
    // Sends and reads; returns "" if nothing comes.
    [[nodiscard]] std::string ask(const std::string& request) const;

  private:
    explicit StatusClient(Descriptor socket) : socket_(std::move(socket)) {}
    Descriptor socket_;
};

// Returns "GET PATH" as HTTP/1.0.
[[nodiscard]] std::string get(const std::string& path);
// Returns the part of an answer after the headers.
[[nodiscard]] std::string body_of(const std::string& answer);

}  // namespace stormcellar::daemon
