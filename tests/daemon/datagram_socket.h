// tests/daemon/datagram_socket.h -- a Unix socket that receives datagrams, for tests that play the
// service manager or the journal.
#pragma once

#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::daemon {

class DatagramSocket {
  public:
    explicit DatagramSocket(std::filesystem::path path)
        : path_(std::move(path)), socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        if (path_.native().size() >= sizeof address.sun_path)
            throw std::runtime_error("the path is too long for a socket");
        std::memcpy(address.sun_path, path_.c_str(), path_.native().size());
        if (::bind(number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
            throw std::runtime_error("bind failed");
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  protected:
    [[nodiscard]] int number() const { return socket_.number(); }
    // Returns true once a datagram has arrived; false if none arrives within `within_ms`.
    [[nodiscard]] bool is_ready(int within_ms) const {
        pollfd source{number(), POLLIN, 0};
        return ::poll(&source, 1, within_ms) > 0;
    }

  private:
    std::filesystem::path path_;
    Descriptor socket_;
};

}  // namespace stormcellar::daemon
