// tests/daemon/notify_socket.h -- the service manager's end of sd_notify.
#pragma once

#include <array>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace stormcellar::daemon {

class NotifySocket {
  public:
    explicit NotifySocket(std::filesystem::path path)
        : path_(std::move(path)), descriptor_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        if (path_.native().size() >= sizeof address.sun_path) {
            throw std::runtime_error("the path is too long for a socket");
        }
        std::memcpy(address.sun_path, path_.c_str(), path_.native().size());
        if (::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            throw std::runtime_error("bind failed");
        }
    }
    NotifySocket(const NotifySocket&) = delete;
    NotifySocket& operator=(const NotifySocket&) = delete;
    ~NotifySocket() { ::close(descriptor_); }

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    // Returns the next message; empty if none comes within the time.
    std::string receive(int within_ms = 100) {
        pollfd source{descriptor_, POLLIN, 0};
        if (::poll(&source, 1, within_ms) <= 0) return {};
        std::array<char, 4096> buffer{};
        const ssize_t length = ::recv(descriptor_, buffer.data(), buffer.size(), 0);
        if (length <= 0) return {};
        return {buffer.data(), static_cast<std::size_t>(length)};
    }

  private:
    std::filesystem::path path_;
    int descriptor_;
};

}  // namespace stormcellar::daemon
