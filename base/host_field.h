// base/host_field.h -- reads the Host field of a request.
//
// Threads   Pure functions.
#pragma once

#include <string_view>

namespace stormcellar {

// Returns the name without its port; empty if the text after the name is not a port.
[[nodiscard]] std::string_view name_in_host_field(std::string_view host) noexcept;

// Returns true if the name is 127.0.0.1, localhost (in any case) or [::1]. Any port is accepted,
// because a tunnel may have another port at its other end and a web page cannot use the names of
// loopback addresses for itself.
//
// A page of the web may give its own name the address 127.0.0.1 (DNS rebinding). A browser then
// takes the answers for that page's own data and hands them over. It sends the page's name as Host,
// so a server that answers only the names of loopback addresses tells such a page nothing.
[[nodiscard]] bool is_loopback_host(std::string_view host) noexcept;

}  // namespace stormcellar
