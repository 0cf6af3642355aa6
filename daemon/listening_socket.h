// daemon/listening_socket.h -- where the status is asked for: a Unix socket, or a loopback port.
//
// Never another address. A Unix socket is of mode 0660. What a killed daemon left at the path is
// taken away, but only a socket on which nobody answers; anything else there is an error.
// Errors: bad_argument (a path of more than 107 bytes), permission, not_found (no such directory),
// io (in use, or whatever else the system says).
// Thread contract: one thread.
#pragma once

#include <filesystem>

#include <sys/types.h>

#include "base/result.h"

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
    // False when the path was removed or replaced by somebody.
    [[nodiscard]] bool still_stands() const;

  private:
    explicit ListeningSocket(int descriptor) : descriptor_(descriptor) {}

    int descriptor_ = -1;
    std::filesystem::path path_;
    dev_t device_ = 0;
    ino_t inode_ = 0;
};

}  // namespace stormcellar::daemon
