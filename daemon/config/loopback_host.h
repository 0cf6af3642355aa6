// daemon/config/loopback_host.h -- whether a request on a loopback port was meant for this machine.
//
// A web page may give its own host name the address 127.0.0.1 (DNS rebinding). A browser then takes
// our answers for data of that page and hands them to it. The browser sends the name of the page as
// Host, so a server that answers only to names of the loopback addresses tells such a page nothing.
// Used only inside the daemon room, by http_listener.h.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <string_view>

namespace stormcellar::daemon {

// Returns true if `host`, the value of a Host field, is 127.0.0.1, localhost (in any case) or
// [::1], followed by nothing or by ":" and a port. Any port is accepted, because a tunnel may use
// another port at its other end, and no page can have the name of a loopback address.
[[nodiscard]] bool is_loopback_host(std::string_view host) noexcept;

}  // namespace stormcellar::daemon
