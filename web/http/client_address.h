// web/http/client_address.h -- whom an address stands for when clients are counted.
//
// Threads   Pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stormcellar::web {

// Reads a numeric address as proxies write it: "192.0.2.7", "192.0.2.7:4711", "2001:db8::7",
// "[2001:db8::7]" and "[2001:db8::7]:4711". Returns it without port and brackets; none if it is
// anything else. An IPv4 address that was mapped to IPv6 is returned as IPv4.
[[nodiscard]] std::optional<std::string> read_address(std::string_view text);

// Returns the name under which a client counts: the network of 64 bits of an IPv6 address, since
// one machine has all addresses of it, and any other address as it is.
[[nodiscard]] std::string client_network(const std::string& address);

}  // namespace stormcellar::web
