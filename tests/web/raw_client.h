// tests/web/raw_client.h -- a client that sends and reads bytes as a test says, on one connection.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::web {

class RawClient {
  public:
    // Connects to 127.0.0.1. `receive_buffer` in bytes makes a client that takes little at a time;
    // `from` is its own address, one of the loopback's.
    explicit RawClient(int port, int receive_buffer = 0, const std::string& from = {});
    [[nodiscard]] bool is_connected() const { return socket_.is_open(); }
    bool send(std::string_view bytes);
    // Reads until the other side closes, or until nothing came for this long.
    std::string read_to_end(std::chrono::milliseconds patience = std::chrono::seconds{5});
    // Reads until what was read contains the text; returns all that was read.
    std::string read_until(std::string_view text,
                           std::chrono::milliseconds patience = std::chrono::seconds{10});
    // Returns true if the other side has closed, within this time.
    bool is_closed(std::chrono::milliseconds patience);
    // Sends a GET with Connection: close and returns all of the answer.
    static std::string get(int port, std::string_view target, std::string_view more_headers = "");

  private:
    std::optional<std::string> read_some(std::chrono::milliseconds patience);  // none: closed
    Descriptor socket_;
    bool has_ended_ = false;
};

// The number behind "HTTP/1.1 "; 0 if there is none.
[[nodiscard]] int status_in(std::string_view answer);
[[nodiscard]] std::string body_in(std::string_view answer);

}  // namespace stormcellar::web
