#include "daemon/status/listening_socket.h"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/system_error.h"

namespace stormcellar::daemon {
namespace {

// As many as the kernel allows (net.core.somaxconn). They wait in the kernel and take no
// descriptor. A client that finds the queue full would try again after 1 s, then 3 s.
constexpr int backlog = SOMAXCONN;
constexpr mode_t socket_mode = 0660;
constexpr mode_t permissions = 07777;

tl::unexpected<Error> system_error(const std::string& what, int error_number) {
    const ErrorCode code =
        error_number == EADDRINUSE ? ErrorCode::busy : error_code_of(error_number);
    return fail(code, "{}: {}", what, std::system_category().message(error_number));
}

Result<int> new_socket(int family, const std::string& what) {
    const int descriptor = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (descriptor < 0) return system_error(what, errno);
    return descriptor;
}

template <class Address>
Status bind_to(int descriptor, const Address& address, const std::string& what) {
    if (::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(descriptor, backlog) != 0) {
        return system_error(what, errno);
    }
    return {};
}

// Returns true if a program listens there.
bool is_answered(const sockaddr_un& address) {
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (descriptor < 0) return true;  // cannot be determined
    const bool refused =
        ::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 &&
        (errno == ECONNREFUSED || errno == ENOENT);
    ::close(descriptor);
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
    if (::unlink(path.c_str()) != 0 && errno != ENOENT) return system_error(path, errno);
    return {};
}

}  // namespace

ListeningSocket::ListeningSocket(ListeningSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      port_(other.port_),
      path_(std::exchange(other.path_, {})),
      device_(other.device_),
      inode_(other.inode_),
      mode_(other.mode_) {}

ListeningSocket::~ListeningSocket() {
    if (descriptor_ < 0) return;
    if (!path_.empty() && still_stands()) ::unlink(path_.c_str());
    ::close(descriptor_);
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
    const Result<int> descriptor = new_socket(AF_UNIX, name);
    if (!descriptor) return pass_on(descriptor);
    ListeningSocket socket(*descriptor);
    // On Linux, bind() gives its file the mode of the socket itself, minus the umask.
    if (::fchmod(*descriptor, socket_mode) != 0) return system_error(name, errno);
    if (const Status bound = bind_to(*descriptor, address, name); !bound) return pass_on(bound);
    struct stat made {};
    if (::lstat(name.c_str(), &made) != 0) return system_error(name, errno);
    socket.path_ = path;
    socket.device_ = made.st_dev;
    socket.inode_ = made.st_ino;
    socket.mode_ = made.st_mode & permissions;
    return socket;
}

Result<ListeningSocket> ListeningSocket::at_port(Loopback loopback, int port) {
    const bool is_new = loopback == Loopback::ipv6;
    const std::string what = fmt::format("{}:{}", is_new ? "[::1]" : "127.0.0.1", port);
    const Result<int> descriptor = new_socket(is_new ? AF_INET6 : AF_INET, what);
    if (!descriptor) return pass_on(descriptor);
    ListeningSocket socket(*descriptor);
    const int yes = 1;
    ::setsockopt(*descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    Status bound;
    if (is_new) {
        ::setsockopt(*descriptor, IPPROTO_IPV6, IPV6_V6ONLY, &yes, sizeof yes);
        sockaddr_in6 address{};
        address.sin6_family = AF_INET6;
        address.sin6_port = htons(static_cast<std::uint16_t>(port));
        address.sin6_addr = IN6ADDR_LOOPBACK_INIT;
        bound = bind_to(*descriptor, address, what);
    } else {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        bound = bind_to(*descriptor, address, what);
    }
    if (!bound) return pass_on(bound);
    socket.port_ = port;
    return socket;
}

}  // namespace stormcellar::daemon
