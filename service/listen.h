// service/listen.h -- opens the sockets on which the servers listen.
//
// Threads   Any thread.
#pragma once

#include <string>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/result.h"

namespace stormcellar {

// Returns a text such as "127.0.0.1:8090" or "[::1]:8090".
[[nodiscard]] std::string address_and_port(const std::string& address, int port);

// Listens on a TCP port of an IPv4 or IPv6 address (without brackets). Port 0 means any free port.
// An IPv6 socket accepts no IPv4 connections. The socket does not block. Errors: bad_argument if
// the address is invalid; busy if the port is in use; permission; io.
[[nodiscard]] Result<Descriptor> listen_at(const std::string& address, int port);

}  // namespace stormcellar
