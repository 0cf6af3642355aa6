// base/host_field.h -- reads the Host field of a request.
//
// Threads   Pure functions.
#pragma once

#include <string_view>

namespace stormcellar {

// Returns the host's name without the port; empty if the field has another form, for example
// without digits after the colon.
[[nodiscard]] std::string_view name_in_host_field(std::string_view host) noexcept;

// Returns true if the field's name is 127.0.0.1, localhost (in upper or lower case) or [::1].
// Accepts any port, because the two ends of a tunnel may have different ports, and a web page
// cannot take the name of a loopback address.
//
// A web page may give its own host name the address 127.0.0.1 (DNS rebinding). A browser then lets
// the page read the answers of a server on this machine. But the browser sends the page's host name
// as Host, so a server that answers only requests for the names of loopback addresses tells such a
// page nothing.
[[nodiscard]] bool is_loopback_host(std::string_view host) noexcept;

}  // namespace stormcellar
