// daemon/status/listening_socket.h -- a socket that serves the status: a Unix socket or a port of a
// loopback address, never of another address.
//
// A Unix socket is created with mode 0660, minus the umask of the thread that opens it. The mode is
// never changed by name, because the name could by then be a link that has replaced the socket. If
// a killed daemon left a socket at the path, at_path() removes it, but only if no program answers
// there. Anything else at the path is an error.
//
// Threads   One thread at a time.
// Errors    bad_argument (an empty path, or more than 107 bytes), permission, not_found (no such
//           directory), busy (in use), io.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include <sys/types.h>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar::daemon {

enum class Loopback { ipv4, ipv6 };

// The destructor closes the socket and removes its path, unless another file is there now.
class ListeningSocket {
  public:
    static Result<ListeningSocket> at_path(const std::filesystem::path& path);
    // Opens a socket at the port of 127.0.0.1 or [::1].
    static Result<ListeningSocket> at_port(Loopback loopback, int port);
    ListeningSocket(ListeningSocket&& other) = default;
    ListeningSocket& operator=(ListeningSocket&&) = delete;
    ListeningSocket(const ListeningSocket&) = delete;
    ListeningSocket& operator=(const ListeningSocket&) = delete;
    ~ListeningSocket();

    [[nodiscard]] int descriptor() const { return socket_.number(); }
    // Returns the port; none for a Unix socket.
    [[nodiscard]] std::optional<int> port() const { return port_; }
    // Returns the permissions of a Unix socket.
    [[nodiscard]] mode_t mode() const { return mode_; }
    // Returns false if the file at the path was removed or replaced.
    [[nodiscard]] bool still_stands() const;

  private:
    explicit ListeningSocket(Descriptor socket) : socket_(std::move(socket)) {}

    Descriptor socket_;
    std::optional<int> port_;
    std::filesystem::path path_;
    dev_t device_ = 0;
    ino_t inode_ = 0;
    mode_t mode_ = 0;
};

}  // namespace stormcellar::daemon
