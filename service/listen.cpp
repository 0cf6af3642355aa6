#include "service/listen.h"

#include <cerrno>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "base/system_error.h"

namespace stormcellar {

std::string address_and_port(const std::string& address, int port) {
    const bool is_v6 = address.find(':') != std::string::npos;
    return is_v6 ? fmt::format("[{}]:{}", address, port) : fmt::format("{}:{}", address, port);
}

Result<Descriptor> listen_at(const std::string& address, int port) {
    sockaddr_storage storage{};
    auto* v4 = reinterpret_cast<sockaddr_in*>(&storage);
    auto* v6 = reinterpret_cast<sockaddr_in6*>(&storage);
    const bool is_v6 = ::inet_pton(AF_INET6, address.c_str(), &v6->sin6_addr) == 1;
    const bool is_address = is_v6 || ::inet_pton(AF_INET, address.c_str(), &v4->sin_addr) == 1;
    const std::string name = address_and_port(address, port);
    if (!is_address || port < 0 || port > 65535)
        return fail(ErrorCode::bad_argument, "{} is not an address of a network interface", name);
    storage.ss_family = is_v6 ? AF_INET6 : AF_INET;
    (is_v6 ? v6->sin6_port : v4->sin_port) = htons(static_cast<std::uint16_t>(port));
    const socklen_t size = is_v6 ? sizeof *v6 : sizeof *v4;
    Descriptor socket(::socket(storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const auto failure = [&] { return system_failure("cannot listen on " + name, errno); };
    if (!socket.is_open()) return failure();
    const int on = 1;
    ::setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    // Accepted connections inherit this option.
    if (is_v6) ::setsockopt(socket.number(), IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
    // Allow a long queue. A client that waits in it takes no descriptor; a client that finds it
    // full tries again only after 1 s, and then after 3 s.
    if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&storage), size) != 0 ||
        ::listen(socket.number(), SOMAXCONN) != 0) {
        return failure();
    }
    return socket;
}

}  // namespace stormcellar
