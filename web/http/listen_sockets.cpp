#include "web/http/listen_sockets.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "base/system_error.h"

namespace stormcellar::web {
namespace {

Result<Descriptor> listen_at(const ListenAddress& where) {
    const bool is_v6 = where.address.find(':') != std::string::npos;
    sockaddr_storage storage{};
    socklen_t size = 0;
    bool is_address = false;
    if (is_v6) {
        auto* v6 = reinterpret_cast<sockaddr_in6*>(&storage);
        v6->sin6_family = AF_INET6;
        v6->sin6_port = htons(static_cast<std::uint16_t>(where.port));
        is_address = ::inet_pton(AF_INET6, where.address.c_str(), &v6->sin6_addr) == 1;
        size = sizeof(sockaddr_in6);
    } else {
        auto* v4 = reinterpret_cast<sockaddr_in*>(&storage);
        v4->sin_family = AF_INET;
        v4->sin_port = htons(static_cast<std::uint16_t>(where.port));
        is_address = ::inet_pton(AF_INET, where.address.c_str(), &v4->sin_addr) == 1;
        size = sizeof(sockaddr_in);
    }
    if (!is_address || where.port < 0 || where.port > 65535) {
        return fail(ErrorCode::bad_argument, "{}:{} is not an address of a network interface",
                    where.address, where.port);
    }
    const std::string what = fmt::format("cannot listen on {}:{}", where.address, where.port);
    Descriptor socket(
        ::socket(is_v6 ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!socket.is_open()) return system_failure(what, errno);
    const int on = 1;
    ::setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    // Accepted connections inherit this option.
    if (is_v6) ::setsockopt(socket.number(), IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
    if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&storage), size) != 0 ||
        ::listen(socket.number(), 1024) != 0) {
        const int reason = errno;
        if (reason == EADDRINUSE) return fail(ErrorCode::busy, "{}: another program does", what);
        return system_failure(what, reason);
    }
    return socket;
}

EndPoint own_end_of(const Descriptor& socket) {
    sockaddr_storage bound{};
    socklen_t size = sizeof bound;
    ::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&bound), &size);
    return end_point_of(reinterpret_cast<const sockaddr*>(&bound));
}

std::string url_of(const EndPoint& end) {
    const bool is_v6 = end.address.find(':') != std::string::npos;
    return is_v6 ? fmt::format("http://[{}]:{}/", end.address, end.port)
                 : fmt::format("http://{}:{}/", end.address, end.port);
}

}  // namespace

EndPoint end_point_of(const sockaddr* raw) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    if (raw->sa_family == AF_INET6) {
        const auto* v6 = reinterpret_cast<const sockaddr_in6*>(raw);
        ::inet_ntop(AF_INET6, &v6->sin6_addr, text.data(), text.size());
        return {text.data(), ntohs(v6->sin6_port)};
    }
    const auto* v4 = reinterpret_cast<const sockaddr_in*>(raw);
    ::inet_ntop(AF_INET, &v4->sin_addr, text.data(), text.size());
    return {text.data(), ntohs(v4->sin_port)};
}

Result<ListenSockets> open_listen_sockets(const std::vector<ListenAddress>& wanted,
                                          const ListenSockets& held) {
    ListenSockets sockets;
    for (const ListenAddress& where : wanted) {
        const auto known = std::ranges::find_if(held, [&](const ListenSocket& one) {
            return one.where.address == where.address &&
                   (one.where.port == where.port || one.port == where.port);
        });
        if (known != held.end()) {
            sockets.push_back(*known);
            continue;
        }
        Result<Descriptor> bound = listen_at(where);
        if (!bound) return pass_on(bound);
        auto socket = std::make_shared<const Descriptor>(std::move(*bound));
        const EndPoint end = own_end_of(*socket);
        sockets.push_back({where, std::move(socket), end.port, url_of(end)});
    }
    return sockets;
}

}  // namespace stormcellar::web
