// web/http/client_address.h -- tells which client an address belongs to, for limits per client.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stormcellar::web {

// Reads a numeric address in the forms that proxies write: "192.0.2.7", "192.0.2.7:4711",
// "2001:db8::7", "[2001:db8::7]" and "[2001:db8::7]:4711". Returns it without port and brackets, or
// none for any other text. Returns an IPv4 address that is mapped to IPv6 as IPv4.
[[nodiscard]] std::optional<std::string> read_address(std::string_view text);

// Returns the name under which a client is counted. For IPv4 this is the address. For IPv6 it is
// the 64-bit network, because one machine can use all addresses of its network.
[[nodiscard]] std::string client_network(const std::string& address);

}  // namespace stormcellar::web
