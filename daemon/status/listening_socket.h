// daemon/status/listening_socket.h -- where the status is asked for: a Unix socket, or a loopback
// port.
//
// Never another address. A Unix socket has mode 0660, less the umask of the thread that opens it,
// from the instant at which it stands: nothing is changed by name afterwards, which could follow a
// link that was put in its place. What a killed daemon left at the path is taken away, but only a
// socket on which nobody answers; anything else there is an error.
// Errors: bad_argument (a path of more than 107 bytes), permission, not_found (no such directory),
// busy (another program listens there), io (whatever else the system says).
// Thread contract: one thread.
#pragma once

#include <filesystem>
#include <optional>

#include <sys/types.h>

#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

enum class Loopback { ipv4, ipv6 };

// Closed, and its path removed if it is still ours, when the object goes.
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
    // None: it is a Unix socket.
    [[nodiscard]] std::optional<int> port() const { return port_; }
    // Of a Unix socket: its permissions, as they came out.
    [[nodiscard]] mode_t mode() const { return mode_; }
    // False when the path was removed or replaced by somebody.
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
