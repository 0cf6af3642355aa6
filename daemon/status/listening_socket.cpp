#include "daemon/status/listening_socket.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/system_error.h"
#include "service/listen.h"

namespace stormcellar::daemon {
namespace {

constexpr mode_t socket_mode = 0660;
constexpr mode_t permissions = 07777;

// Returns true if a program listens at the path, or if that cannot be determined.
bool is_answered(const sockaddr_un& address) {
    const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!socket.is_open()) return true;  // this cannot be determined
    const bool refused = ::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address),
                                   sizeof address) != 0 &&
                         (errno == ECONNREFUSED || errno == ENOENT);
    return !refused;
}

Status make_way(const sockaddr_un& address) {
    struct stat found {};
    const std::string path = static_cast<const char*>(address.sun_path);
    if (::lstat(path.c_str(), &found) != 0) return {};
    if (!S_ISSOCK(found.st_mode))
        return fail(ErrorCode::io, "{}: exists and is not a socket", path);
    if (is_answered(address))
        return fail(ErrorCode::busy, "{}: another program uses this socket", path);
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) return system_failure(path, errno);
    return {};
}

}  // namespace

ListeningSocket::~ListeningSocket() {
    if (socket_.is_open() && !path_.empty() && still_stands()) ::unlink(path_.c_str());
}

bool ListeningSocket::still_stands() const {
    if (path_.empty()) return true;
    struct stat found {};
    return ::lstat(path_.c_str(), &found) == 0 && found.st_dev == device_ && found.st_ino == inode_;
}

Result<ListeningSocket> ListeningSocket::at_path(const std::filesystem::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string& name = path.native();
    if (name.empty() || name.size() >= sizeof address.sun_path) {
        return fail(ErrorCode::bad_argument, "{}: the path of a socket must have 1 to {} bytes",
                    name, sizeof address.sun_path - 1);
    }
    std::memcpy(static_cast<char*>(address.sun_path), name.data(), name.size());
    if (const Status free = make_way(address); !free) return pass_on(free);
    Descriptor made(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    // On Linux, bind() gives the new file at the path the mode of the socket, minus the umask.
    if (!made.is_open() || ::fchmod(made.number(), socket_mode) != 0 ||
        ::bind(made.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(made.number(), SOMAXCONN) != 0) {
        return system_failure(name, errno);
    }
    ListeningSocket socket(std::move(made));
    struct stat facts {};
    if (::lstat(name.c_str(), &facts) != 0) return system_failure(name, errno);
    socket.path_ = path;
    socket.device_ = facts.st_dev;
    socket.inode_ = facts.st_ino;
    socket.mode_ = facts.st_mode & permissions;
    return socket;
}

Result<ListeningSocket> ListeningSocket::at_port(Loopback loopback, int port) {
    Result<Descriptor> made = listen_at(loopback == Loopback::ipv6 ? "::1" : "127.0.0.1", port);
    if (!made) return pass_on(made);
    ListeningSocket socket(*std::move(made));
    socket.port_ = port;
    return socket;
}

}  // namespace stormcellar::daemon
