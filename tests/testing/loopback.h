// tests/testing/loopback.h -- sockets on 127.0.0.1.
#pragma once

#include <cstdint>

#include <netinet/in.h>
#include <sys/socket.h>

#include "stormcellar/base/descriptor.h"

namespace stormcellar::testing {

[[nodiscard]] inline sockaddr_in loopback_address(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

// Returns a connection to the port; a closed descriptor if nobody listens there.
[[nodiscard]] inline Descriptor connection_to(int port) {
    Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_in address = loopback_address(port);
    if (::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) !=
        0)
        return Descriptor{};
    return socket;
}

// Returns a socket that has a port, but does not listen yet; a closed descriptor if there is no
// port.
[[nodiscard]] inline Descriptor bound_socket() {
    Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_in address = loopback_address(0);
    if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return Descriptor{};
    return socket;
}

[[nodiscard]] inline int port_of(const Descriptor& socket) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
}

// Returns a port that nobody uses at this moment.
[[nodiscard]] inline int free_port() {
    return port_of(bound_socket());
}

}  // namespace stormcellar::testing
