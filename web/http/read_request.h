// web/http/read_request.h -- checks what libmicrohttpd has read, and makes a Request of it or
// refuses it.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "web/http/request.h"
#include "web/http/server_options.h"

namespace stormcellar::web {

// A request as it came over the network.
struct RawRequest {
    std::string method, target;  // as sent: the path with its query
    bool is_http_1_0 = false;
    Fields headers;
    std::string client;  // the address at the other end
};

struct Refusal {
    unsigned status = 400;
    std::string reason;
};

// The names and addresses of this server, and the proxies that it trusts.
struct Identity {
    std::set<std::string> names;    // lower case, without ports; "*": any
    std::set<std::string> proxies;  // addresses of trusted proxies
    std::string public_address, prefix;
};
[[nodiscard]] Identity identity_of(const ServerOptions& options);

// Returns true if a Host field names this server: if it is a loopback name, or one of `names`, with
// any port.
[[nodiscard]] bool names_us(std::string_view host, const Identity& identity);

// A decoded request, and the answer that refuses it; none: the request may be answered.
struct Reading {
    Request request;
    std::optional<Refusal> refusal;
};
[[nodiscard]] Reading read_request(const RawRequest& raw, const Identity& identity);

}  // namespace stormcellar::web
