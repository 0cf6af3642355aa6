// tests/daemon/notify_socket.h -- receives the messages that a service sends to its manager
// (sd_notify).
#pragma once

#include <array>
#include <string>
#include <string_view>

#include <sys/socket.h>

#include "tests/daemon/datagram_socket.h"

namespace stormcellar::daemon {

class NotifySocket : public DatagramSocket {
  public:
    using DatagramSocket::DatagramSocket;

    // Returns the next message; empty if none comes in time.
    std::string receive(int within_ms = 100) {
        if (!is_ready(within_ms)) return {};
        std::array<char, 4096> buffer{};
        const ssize_t length = ::recv(number(), buffer.data(), buffer.size(), 0);
        if (length <= 0) return {};
        return {buffer.data(), static_cast<std::size_t>(length)};
    }
    // Returns true once a message comes that begins with this text; false if none comes in time.
    bool hears(std::string_view text) {
        for (int i = 0; i < 600; ++i)
            if (receive().starts_with(text)) return true;
        return false;
    }
};

}  // namespace stormcellar::daemon
