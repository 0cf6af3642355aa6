#include "web/http/listen_sockets.h"

#include <algorithm>
#include <array>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "service/listen.h"

namespace stormcellar::web {
namespace {

EndPoint own_end_of(const Descriptor& socket) {
    sockaddr_storage bound{};
    socklen_t size = sizeof bound;
    ::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&bound), &size);
    return end_point_of(reinterpret_cast<const sockaddr*>(&bound));
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
        Result<Descriptor> bound = listen_at(where.address, where.port);
        if (!bound) return pass_on(bound);
        auto socket = std::make_shared<const Descriptor>(std::move(*bound));
        const EndPoint end = own_end_of(*socket);
        sockets.push_back({where, std::move(socket), end.port,
                           fmt::format("http://{}/", address_and_port(end.address, end.port))});
    }
    return sockets;
}

}  // namespace stormcellar::web
