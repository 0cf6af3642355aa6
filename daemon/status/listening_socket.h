// daemon/status/listening_socket.h -- the socket that serves the status: a Unix socket, or a
// loopback port.
//
// It never listens at another address. A Unix socket has mode 0660, less the umask of the thread
// that opens it, from the instant at which it exists. Nothing is changed by name afterwards,
// because that could follow a link that was put in its place. A socket that a killed daemon left at
// the path is removed if nobody answers on it; anything else there is an error. Errors:
// bad_argument (a path of more than 107 bytes), permission, not_found (no such directory), busy
// (another program listens there), io (all other failures). Thread contract: one thread.
#pragma once

#include <filesystem>
#include <optional>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

enum class Loopback { ipv4, ipv6 };

// The destructor closes the socket, and removes its path if that is still this socket.
class ListeningSocket {
  public:
    static Result<ListeningSocket> at_path(const std::filesystem::path& path);
    // 127.0.0.1 or [::1].
    static Result<ListeningSocket> at_port(Loopback loopback, int port);
    ListeningSocket(ListeningSocket&& other) noexcept;
    ListeningSocket& operator=(ListeningSocket&&) = delete;
    ListeningSocket(const ListeningSocket&) = delete;
    ListeningSocket& operator=(const ListeningSocket&) = delete;
    ~ListeningSocket();

    [[nodiscard]] int descriptor() const { return descriptor_; }
    // None for a Unix socket.
    [[nodiscard]] std::optional<int> port() const { return port_; }
    // The permissions that a Unix socket really has.
    [[nodiscard]] mode_t mode() const { return mode_; }
    // Returns false if somebody removed or replaced the path.
    [[nodiscard]] bool still_stands() const;

  private:
    explicit ListeningSocket(int descriptor) : descriptor_(descriptor) {}

    int descriptor_ = -1;
    std::optional<int> port_;
    std::filesystem::path path_;
    dev_t device_ = 0;
    ino_t inode_ = 0;
    mode_t mode_ = 0;
};

}  // namespace stormcellar::daemon
