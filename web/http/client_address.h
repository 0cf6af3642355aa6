// web/http/client_address.h -- maps addresses to clients, for limits per client.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stormcellar::web {

// Reads a numeric address as proxies write it: "192.0.2.7", "192.0.2.7:4711", "2001:db8::7",
// "[2001:db8::7]" and "[2001:db8::7]:4711". Returns it without port and brackets; none for any
// other text. An IPv4 address mapped to IPv6 is returned as IPv4.
[[nodiscard]] std::optional<std::string> read_address(std::string_view text);

// Returns the name under which a client is counted. For IPv6 this is the 64-bit network, since one
// machine can use all of its addresses; for IPv4 it is the address.
[[nodiscard]] std::string client_network(const std::string& address);

}  // namespace stormcellar::web
