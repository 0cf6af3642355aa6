// web/http/listen_sockets.h -- the sockets on which a server listens. They are not part of the
// server, so that a new server can replace the old one without closing a port, which another
// program could take.
//
// Threads   Plain values. Many objects may share a socket.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"
#include "web/http/server_options.h"

struct sockaddr;

namespace stormcellar::web {

// The address and port of one end of a socket.
struct EndPoint {
    std::string address;
    int port = 0;
};
[[nodiscard]] EndPoint end_point_of(const sockaddr* raw);

struct ListenSocket {
    ListenAddress where;  // the requested address
    std::shared_ptr<const Descriptor> socket;
    int port = 0;     // the actual port
    std::string url;  // "http://127.0.0.1:8090/"
};
using ListenSockets = std::vector<ListenSocket>;

// Returns a socket for each address. Takes it from `held` if `held` has one for the address, else
// opens a new one. Errors: busy if an address is in use; bad_argument for a text that is not an
// address; io.
[[nodiscard]] Result<ListenSockets> open_listen_sockets(const std::vector<ListenAddress>& wanted,
                                                        const ListenSockets& held = {});

}  // namespace stormcellar::web
