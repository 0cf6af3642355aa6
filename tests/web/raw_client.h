// tests/web/raw_client.h -- a client that sends the bytes of a test on one connection, and reads
// the answer.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::web {

class RawClient {
  public:
    // Connects to 127.0.0.1. A small `receive_buffer`, in bytes, makes a slow client; 0: the
    // system's size. `from` is the client's own loopback address.
    explicit RawClient(int port, int receive_buffer = 0, const std::string& from = {});
    [[nodiscard]] bool is_connected() const { return socket_.is_open(); }
    bool send(std::string_view bytes);
    // Reads until the server closes the connection, or until nothing came for `patience`.
    std::string read_to_end(std::chrono::milliseconds patience = std::chrono::seconds{5});
    // Reads until the text has come, and returns all bytes that were read. Also ends if nothing
    // came for `patience`.
    std::string read_until(std::string_view text,
                           std::chrono::milliseconds patience = std::chrono::seconds{10});
    // Returns true if the server closes the connection within `patience`.
    bool is_closed(std::chrono::milliseconds patience);
    // Sends a GET with Connection: close and returns all of the answer.
    static std::string get(int port, std::string_view target, std::string_view more_headers = "");

  private:
    std::optional<std::string> read_some(std::chrono::milliseconds patience);  // none if closed
    Descriptor socket_;
    bool has_ended_ = false;
};

// Returns the number after "HTTP/1.1 "; 0 if there is none.
[[nodiscard]] int status_in(std::string_view answer);
[[nodiscard]] std::string body_in(std::string_view answer);

}  // namespace stormcellar::web
