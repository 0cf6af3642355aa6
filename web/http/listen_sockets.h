// web/http/listen_sockets.h -- the sockets on which a server listens. They are apart from the
// server so that one server can follow another without closing a port, which another program could
// take.
//
// Threads   Plain values; many may share a socket.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"
#include "web/http/server_options.h"

struct sockaddr;

namespace stormcellar::web {

// The address and port of a socket's other or own end.
struct EndPoint {
    std::string address;
    int port = 0;
};
[[nodiscard]] EndPoint end_point_of(const sockaddr* raw);

struct ListenSocket {
    ListenAddress where;  // as it was asked for
    std::shared_ptr<const Descriptor> socket;
    int port = 0;     // that it has
    std::string url;  // "http://127.0.0.1:8090/"
};
using ListenSockets = std::vector<ListenSocket>;

// Returns a socket for each address: that of `held` if this has one for the same address, else a
// new one. Errors: busy: an address is in use; bad_argument: it is no address; io.
[[nodiscard]] Result<ListenSockets> open_listen_sockets(const std::vector<ListenAddress>& wanted,
                                                        const ListenSockets& held = {});

}  // namespace stormcellar::web
